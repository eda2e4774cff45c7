// SPDX-License-Identifier: GPL-2.0-or-later
// The last problem of ContactDynamicsEngine with an explicit W, for other solvers and other measures. The solve itself never assembles W.
#include "ContactDynamicsStep.hpp"
#include <boost/python/tuple.hpp>
#include <pkg/solver/AssembledGrains.hpp>
#include <pkg/solver/ConvergenceNorms.hpp>
#include <pkg/solver/LocalDelassus.hpp>
#include <stdexcept>

namespace yade {
namespace {
constexpr std::size_t largestFull = 1000; // contacts: W has 9e6 numbers then, which as a Python list take 0.3 GB

template <class Values> boost::python::list listOf(const Values& values)
{
	boost::python::list list;
	for (const auto& value : values) list.append(value);
	return list;
}
} // namespace

contactdynamics::BlockProblem ContactDynamicsStep::assembledProblem(const char* caller) const
{
	if (!solved)
		throw std::runtime_error(
				std::string("ContactDynamicsEngine.") + caller +
				": no step has been solved yet (or the last one ended with an error before the solve, or one is under way: O.pause() first).");
	if (problem.meanField && !problem.meanField->inverseMass.isZero(0) && problem.contacts.size() > largestFull)
		throw std::runtime_error(
				std::string("ContactDynamicsEngine.") + caller +
				": the cell of a ContactDynamicsCellController couples all contacts with each other, so W is full; that is written out for at most " +
				std::to_string(largestFull) + " contacts, and there are " + std::to_string(problem.contacts.size()) + '.');
	const contactdynamics::GrainProblem grains = shifted.asSolved(problem);
	std::vector<Matrix3r> frames(grains.contacts.size());
	for (std::size_t i = 0; i < frames.size(); i++) {
		// A swapped contact stands in the problem with the opposite normal; its components stay those of the YADE interaction.
		const Real sign = links[i].swapped ? -1 : 1;
		frames[i] = sign * contactdynamics::contactFrame(sign * grains.contacts[i].normal);
	}
	contactdynamics::BlockProblem blocks = contactdynamics::assembled(grains, frames);
	if (shifted.empty() &&
		!problem.meanField) // then nothing but gravity and other known forces is in q: from these, and not from u - W r, for an independent check
		for (std::size_t i = 0; i < frames.size(); i++) {
			const contactdynamics::Contact& contact = grains.contacts[i];
			Eigen::Map<Vector3r>(&blocks.q[3 * i]) =
					frames[i] * relativeVelocity(contact, freeOf(contact.body1), freeOf(contact.body2)) + Vector3r(contact.gapVelocity, 0, 0);
		}
	return blocks;
}

boost::python::dict ContactDynamicsStep::asDictionary() const
{
	const contactdynamics::BlockProblem blocks = assembledProblem("lastProblem");
	boost::python::list bodies;
	for (const contactdynamics::Contact& contact : problem.contacts)
		bodies.append(boost::python::make_tuple(idOfIndex[contact.body1], idOfIndex[contact.body2]));
	boost::python::dict result;
	result["dimension"] = blocks.dimension;
	result["rowStart"] = listOf(blocks.rowStart);
	result["column"] = listOf(blocks.column);
	result["blocks"] = listOf(blocks.blocks);
	result["q"] = listOf(blocks.q);
	result["friction"] = listOf(blocks.friction);
	result["impulse"] = listOf(blocks.impulse);
	result["velocity"] = listOf(blocks.velocity);
	result["bodies"] = bodies;
	return result;
}

boost::python::dict ContactDynamicsStep::normsAsDictionary() const
{
	const contactdynamics::ConvergenceNorms norms = contactdynamics::convergenceNorms(assembledProblem("convergenceNorms"));
	boost::python::dict result;
	result["naturalMap"] = norms.naturalMap;
	result["siconos"] = norms.siconos;
	result["quadDV"] = norms.quadDV;
	result["quadDVR"] = norms.quadDVR;
	result["meanDVoR"] = norms.meanDVoR;
	result["quadraticAccuracy"] = norms.quadraticAccuracy;
	result["largestAccuracy"] = norms.largestAccuracy;
	result["active"] = norms.active;
	return result;
}

} // namespace yade
