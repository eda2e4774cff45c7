// SPDX-License-Identifier: GPL-2.0-or-later
// The last problem of ContactDynamicsEngine with an explicit W, for other solvers. The solve itself never assembles W.
#include "ContactDynamicsStep.hpp"
#include "LocalFrame.hpp"
#include <boost/python/tuple.hpp>
#include <algorithm>
#include <map>
#include <stdexcept>

namespace yade {
namespace {
template <class Matrix> void append(boost::python::list& list, const Matrix& rows)
{
	for (int row = 0; row < rows.rows(); row++)
		for (int column = 0; column < rows.cols(); column++) list.append(rows(row, column));
}
} // namespace

boost::python::dict ContactDynamicsStep::asDictionary() const
{
	if (!solved)
		throw std::runtime_error(
				"ContactDynamicsEngine.lastProblem: no step has been solved yet (or the last one ended with an error before the solve).");
	if (problem.meanField)
		throw std::runtime_error(
				"ContactDynamicsEngine.lastProblem: the cell of a ContactDynamicsCellController couples all contacts with each other; "
				"such a problem has no sparse W.");
	const std::size_t count = problem.contacts.size();
	std::vector<Matrix3r> frames(count);
	std::vector<std::vector<int>> contactsOf(problem.bodies.size());
	const contactdynamics::GrainProblem grains = shifted.asSolved(problem);
	for (std::size_t i = 0; i < count; i++) {
		const auto& contact = grains.contacts[i];
		// A swapped contact stands in the problem with the opposite normal; its components stay those of the YADE interaction.
		const Real sign = links[i].swapped ? -1 : 1;
		frames[i] = sign * localFrame(sign * contact.normal);
		for (const int body : {contact.body1, contact.body2}) {
			const auto& own = grains.bodies[body];
			// A body that nothing moves links no contacts: those of a wall with each other would be their number squared.
			if (!own.inverseMass.isZero(0) || !own.inverseInertia.isZero(0)) contactsOf[body].push_back(static_cast<int>(i));
		}
	}

	boost::python::list rowStart, column, blocks, q, friction, impulse, velocity, bodies;
	rowStart.append(0);
	std::size_t entries = 0;
	for (std::size_t i = 0; i < count; i++) {
		const auto& contact = grains.contacts[i];
		std::map<int, Matrix3r> row;
		row[static_cast<int>(i)] = Matrix3r::Zero();
		for (const int body : {contact.body1, contact.body2}) {
			const auto& own = grains.bodies[body];
			const bool is2 = body == contact.body2;
			const Vector3r armI = is2 ? contact.arm2 : contact.arm1;
			for (const int j : contactsOf[body]) {
				const auto& other = grains.contacts[j];
				const bool other2 = body == other.body2;
				Matrix3r& W = row.emplace(j, Matrix3r::Zero()).first->second;
				for (int k = 0; k < 3; k++) { // velocity at contact i from a unit impulse along axis k of contact j
					const Vector3r push = (is2 == other2 ? 1 : -1) * frames[j].row(k).transpose();
					const Vector3r turned = own.inverseInertia * (other2 ? other.arm2 : other.arm1).cross(push);
					W.col(k) += frames[i] * (own.inverseMass.cwiseProduct(push) + turned.cross(armI));
				}
			}
		}
		// A mortar adds to the diagonal. Cohesion and rolling friction are external to the problem, in q: so that is what u = W r + q leaves.
		const Vector3r compliance(contact.normalCompliance, contact.tangentialCompliance, contact.tangentialCompliance);
		row[static_cast<int>(i)].diagonal() += compliance;
		const Vector3r gapVelocity(contact.gapVelocity, 0, 0), own = frames[i] * contact.impulse;
		const Vector3r u = frames[i] * contact.relativeVelocity + gapVelocity + compliance.cwiseProduct(own);
		Vector3r left = u;
		for (const auto& [j, W] : row) left -= W * (frames[j] * grains.contacts[j].impulse);
		for (const auto& [j, W] : row) {
			column.append(j);
			append(blocks, W);
			entries++;
		}
		rowStart.append(entries);

		const Twist &of1 = free[contact.body1], &of2 = free[contact.body2];
		append(q, shifted.empty() ? Vector3r(frames[i] * relativeVelocity(contact, of1, of2) + gapVelocity) : left);
		append(velocity, u);
		append(impulse, own);
		friction.append(contact.friction);
		bodies.append(boost::python::make_tuple(idOfIndex[contact.body1], idOfIndex[contact.body2]));
	}
	boost::python::dict result;
	result["dimension"] = 3;
	result["rowStart"] = rowStart;
	result["column"] = column;
	result["blocks"] = blocks;
	result["q"] = q;
	result["friction"] = friction;
	result["impulse"] = impulse;
	result["velocity"] = velocity;
	result["bodies"] = bodies;
	return result;
}

} // namespace yade
