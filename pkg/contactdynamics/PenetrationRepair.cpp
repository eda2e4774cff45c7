// SPDX-License-Identifier: GPL-2.0-or-later
#include "PenetrationRepair.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <pkg/solver/RoomToGrow.hpp>

namespace yade {
namespace {
/// Sweeps a step, at most, there and back in turn. Packings of 150 and 400 grains with overlaps of 1 % are repaired alike with
/// 4, 10 and 40; in a pour 4 leave overlaps a tenth larger than 10 do, for half the time.
constexpr int sweeps = 4;
/// Bodies are at rest when a sweep displaces them by less than this, of the largest displacement asked for.
constexpr Real settled = 1e-3;
/// gamma of the class comment, the compliance of the pull in units of W.
constexpr Real pullCompliance = 1e-3;
} // namespace

PenetrationRepair::Row PenetrationRepair::describe(const contactdynamics::Contact& contact, const Candidate& candidate, Real share, Real allowed)
{
	Row row;
	row.body1 = contact.body1;
	row.body2 = contact.body2;
	row.normal = contact.normal;
	Real mobility = contact.normal.dot((mobilities[row.body1] + mobilities[row.body2]).cwiseProduct(contact.normal));
	if (cellYields) {
		const Matrix3r dyad = contact.normal * (contact.arm1 - contact.arm2).transpose();
		stretches.emplace_back(0.5 * (dyad + dyad.transpose()));
		mobility += mobilityOfCell.cwiseProduct(stretches.back()).cwiseProduct(stretches.back()).sum();
	}
	row.weight = mobility > 0 ? 1 / mobility : 0;
	const bool loaded = contact.impulse != Vector3r::Zero();
	const Real room = candidate.gap + 0.5 * allowed * candidate.size;
	row.target = room < 0 ? -share * room : -room;
	// A loaded contact keeps a cushion of overlap: a gap of one rounding error is enough to lose the friction that holds a wedged grain.
	if (loaded && room > 0) row.target = -std::min(room, 0.5 * allowed * candidate.size);
	row.yielding = loaded ? 1 / (1 + pullCompliance) : 0;
	return row;
}

/// Change of the distance of the two bodies so far [m].
Real PenetrationRepair::way(std::size_t i) const
{
	const Row& row = rows[i];
	return row.normal.dot(displacements[row.body2] - displacements[row.body1]) + stretch(i);
}

void PenetrationRepair::move(std::size_t i, Real pseudoImpulse)
{
	const Row& row = rows[i];
	const Vector3r along = pseudoImpulse * row.normal;
	displacements[row.body1] -= mobilities[row.body1].cwiseProduct(along);
	displacements[row.body2] += mobilities[row.body2].cwiseProduct(along);
	if (cellYields) cellStrain += pseudoImpulse * mobilityOfCell.cwiseProduct(stretches[i]);
}

/// Solves one row, all others held; returns the change of the distance of the two bodies [m].
Real PenetrationRepair::visit(std::size_t i, Real& pseudoImpulse)
{
	const Row& row = rows[i];
	const Real rigid = pseudoImpulse + row.weight * (row.target - way(i));
	const Real change = (rigid > 0 ? rigid : row.yielding * rigid) - pseudoImpulse;
	if (change == 0) return 0;
	pseudoImpulse += change;
	move(i, change);
	return std::abs(change) / row.weight;
}

/// There and back in turn. After the first sweep only rows with a body that the last one displaced are visited: most overlaps are few and far apart.
/// A cell that yields concerns every row.
void PenetrationRepair::sweep(std::vector<Candidate>& candidates, Real unnoticed)
{
	const auto count = static_cast<long>(rows.size());
	stirred.assign(displacements.size(), 1);
	for (int done = 0; done < sweeps; done++) {
		restless.assign(displacements.size(), cellYields);
		bool any = false;
		for (long k = 0; k < count; k++) {
			const long i = done % 2 == 0 ? k : count - 1 - k;
			const Row& row = rows[i];
			if (!(stirred[row.body1] || stirred[row.body2]) || row.weight == 0) continue;
			if (visit(i, candidates[i].pseudoImpulse) <= unnoticed) continue;
			restless[row.body1] = restless[row.body2] = any = true;
		}
		if (!any) return;
		stirred.swap(restless);
	}
}

void PenetrationRepair::solve(const contactdynamics::GrainProblem& solved, std::vector<Candidate>& candidates, Real share, Real allowed,
							  const Matrix3r& cellMobility)
{
	displacements.assign(solved.bodies.size(), Vector3r::Zero());
	mobilities.resize(solved.bodies.size());
	for (std::size_t i = 0; i < solved.bodies.size(); i++) mobilities[i] = solved.bodies[i].inverseMass;
	cellYields = !cellMobility.isZero(0);
	mobilityOfCell = cellMobility;
	cellStrain.setZero();
	rows.clear();
	contactdynamics::reserveWithRoom(rows, candidates.size());
	stretches.clear();
	Real smallest = std::numeric_limits<Real>::infinity(), asked = 0;
	for (Candidate& candidate : candidates) {
		rows.push_back(describe(solved.contacts[candidate.contact], candidate, share, allowed));
		const Row& row = rows.back();
		smallest = std::min(smallest, candidate.size);
		asked = std::max(asked, row.target);
		if (row.weight == 0 || (row.yielding == 0 && candidate.pseudoImpulse < 0)) candidate.pseudoImpulse = 0;
	}
	for (std::size_t i = 0; i < rows.size(); i++)
		if (candidates[i].pseudoImpulse != 0) move(i, candidates[i].pseudoImpulse *= asked);
	sweep(candidates, settled * asked);
	for (Candidate& candidate : candidates) candidate.pseudoImpulse /= asked;
	limit(largestWay * smallest);
	holdBack(candidates, allowed);
}

/// Scaling all displacements alike keeps them admissible: the way of no contact grows.
void PenetrationRepair::limit(Real allowedDisplacement)
{
	largest = 0;
	for (const Vector3r& displacement : displacements) largest = std::max(largest, displacement.norm());
	Real ofCell = 0;
	for (std::size_t i = 0; i < stretches.size(); i++) ofCell = std::max(ofCell, std::abs(stretch(i)));
	largest += ofCell;
	if (largest <= allowedDisplacement) return;
	for (Vector3r& displacement : displacements) displacement *= allowedDisplacement / largest;
	cellStrain *= allowedDisplacement / largest;
	largest = allowedDisplacement;
}

/// One sweep a step is no solution. Where it would make an overlap of faces deeper than any is, and than twice what is left alone, displacements and
/// pseudo-impulses are shortened, if need be to nothing: the deepest overlap is what the next step asks for, and a wall of bricks at rest asked for
/// more and more. Not for points: a soft packing of balls has to pass through such steps, and always comes out of them.
void PenetrationRepair::holdBack(std::vector<Candidate>& candidates, Real allowed)
{
	Real deepest = 0, part = 1;
	for (const Candidate& candidate : candidates) deepest = std::max(deepest, -candidate.deepest);
	for (std::size_t i = 0; i < rows.size(); i++) {
		const Real least = -std::max(deepest, 2 * allowed * candidates[i].size), its = way(i);
		if (candidates[i].faces && its < 0 && candidates[i].deepest + its < least)
			part = std::min(part, std::abs((least - candidates[i].deepest) / its));
	}
	if (part == 1) return;
	for (Vector3r& displacement : displacements) displacement *= part;
	cellStrain *= part;
	largest *= part;
	for (Candidate& candidate : candidates) candidate.pseudoImpulse *= part;
}

Real PenetrationRepair::remainingOverlap(const std::vector<Candidate>& candidates) const
{
	Real remaining = 0;
	for (std::size_t i = 0; i < rows.size(); i++) remaining = std::max(remaining, -(candidates[i].deepest + way(i)));
	return remaining;
}

} // namespace yade
