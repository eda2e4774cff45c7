// SPDX-License-Identifier: GPL-2.0-or-later
#include "OtherContacts.hpp"
#include "ContactDynamicsPhys.hpp"
#include <core/Interaction.hpp>
#include <core/Scene.hpp>

namespace yade {
namespace {
const State& massCentre(const Scene& scene, int id)
{
	const Body& body = *(*scene.bodies)[id];
	return *(body.isClumpMember() ? *(*scene.bodies)[body.clumpId] : body).state;
}
} // namespace

Matrix3r stressOfOtherContacts(const Scene& scene)
{
	Matrix3r sum = Matrix3r::Zero();
	const int count = static_cast<int>(scene.bodies->size());
	// Body by body, because the list of all interactions is in an order that depends on threads and history.
	for (int id = 0; id < count; id++) {
		if (!(*scene.bodies)[id]) continue;
		for (const auto& [other, interaction] : (*scene.bodies)[id]->intrs) {
			if (other <= id || other >= count || !(*scene.bodies)[other] || !interaction->geom || !interaction->phys) continue;
			const auto* phys = dynamic_cast<const NormShearPhys*>(interaction->phys.get());
			if (!phys || dynamic_cast<const ContactDynamicsPhys*>(phys)) continue;
			const Vector3r branch = massCentre(scene, interaction->getId1()).pos - massCentre(scene, interaction->getId2()).pos -
									scene.cell->hSize * interaction->cellDist.cast<Real>();
			sum += (phys->normalForce + phys->shearForce) * branch.transpose();
		}
	}
	return sum / scene.cell->hSize.determinant();
}

} // namespace yade
