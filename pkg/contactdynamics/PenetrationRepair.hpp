// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/solver/GrainProblem.hpp>
#include <cstdint>
#include <vector>

namespace yade {

/// Removes overlaps by moving bodies, not by pushing them: the displacements d = M^-1 H p of frictionless pseudo-impulses p [kg m] with
///
///     0 <= d_N + s _|_ p_N >= 0,   s = room           where room = gap + half the allowed overlap is >= 0
///                                  s = share room     where it is < 0: all overlaps shrink by the same share in a step.
///
/// Nothing of it enters a velocity, so that no overlap, however large, becomes kinetic energy; with the true masses, a free cluster keeps its mass
/// centre. A push through the velocity, as `signorini` (24) makes it, was rejected for the repair because of that energy. Bodies are moved without
/// being turned: a turn would change the lever arms and the inertia tensor for which the contact problem has just been solved, and a translation
/// parts any two bodies, whatever their shape and in however many points they touch.
///
/// A contact that carries a reaction (loaded) opens only against a pull, d_N + s = -gamma W p for p < 0, s <= 0: without it, contacts of a packing
/// open, lose their reaction, and the grains they held fall. The pull yields, because in a packing with more contacts than degrees of freedom not all
/// can keep their distance. Rejected: a pull up to a fixed strength, which the solution reaches at exactly those contacts, after hundreds of sweeps;
/// friction in the displacements (a grain wedged by friction loses its hold just the same when 1 % of overlap leaves the packing).
///
/// A few sweeps a step are enough, from the pseudo-impulses of the step before: what is left is overlap or gap, never energy, and its turn comes.
/// They are stored over the largest displacement asked for, because all displacements shrink in proportion.
///
/// A periodic cell that gives way is strained by the pseudo-impulses, E = sum sym(p normal b^T) / M, as MeanField is by impulses: d are displacements
/// relative to it, and E b is added at a contact. In a fixed cell a jammed packing has nowhere to go.
class PenetrationRepair {
public:
	/// What the repair needs to know of a contact beside the solved problem.
	struct Candidate {
		int contact;		// index into the contacts of the problem; one that carries an impulse where any of the pair does
		Real gap;			// the larger one of those at the start and at the end of the step: an overlap that the motion removes is none [m]
		Real deepest;		// of all points of the pair, <= gap [m]
		Real size;			// what an overlap is measured against [m]
		bool faces;			// touch in several points
		Real pseudoImpulse; // in: of the step before, out: of this step; over the largest displacement asked for [kg]
	};

	/// @param solved      the contact problem after the solve: mobilities, normals, and which contacts carry an impulse
	/// @param candidates  all contacts that the displacements might close; those that are left out are not looked after
	/// @param share       of the room beyond the allowed overlap that is taken away [-], 0 ... 1
	/// @param allowed     overlap that is left alone, in sizes [-], >= 0
	/// @param cellMobility  1/M by component of the cell's strain, 0 where it does not give way [1/(kg m2)]
	void solve(const contactdynamics::GrainProblem& solved, std::vector<Candidate>& candidates, Real share, Real allowed,
			   const Matrix3r& cellMobility);

	const Vector3r& displacement(int body) const { return displacements[body]; } // by solver index, relative to the cell [m]
	const Matrix3r& strain() const { return cellStrain; }						 // E [-], symmetric
	Real largestDisplacement() const { return largest; }						 // of a body relative to the cell, plus the largest |normal.E b| [m]
	Real remainingOverlap(const std::vector<Candidate>& candidates) const;		 // largest, at the end of the step [m]

	/// Largest displacement in a step, in the smallest size: a fifth of the least proximity margin, so that no contact comes unseen.
	static constexpr Real largestWay = 1e-2;

private:
	struct Row {
		int body1, body2;
		Vector3r normal;
		Real target;   // -s [m]
		Real weight;   // 1 / W [kg]
		Real yielding; // of the pull: p < 0 shrinks by this factor; 0: no pull
	};
	std::vector<Row> rows;			 // parallel to the candidates
	std::vector<Matrix3r> stretches; // likewise, if the cell yields: change of distance per strain, sym(normal b^T) [m]
	std::vector<Vector3r> displacements, mobilities;
	bool cellYields = false;
	Matrix3r mobilityOfCell, cellStrain;
	std::vector<std::uint8_t> stirred, restless; // bodies that the last sweep displaced, and this one
	Real largest = 0;

	Row describe(const contactdynamics::Contact& contact, const Candidate& candidate, Real share, Real allowed);
	Real stretch(std::size_t row) const { return cellYields ? cellStrain.cwiseProduct(stretches[row]).sum() : 0; } // by the cell [m]
	Real way(std::size_t row) const;
	void move(std::size_t row, Real pseudoImpulse);
	Real visit(std::size_t row, Real& pseudoImpulse);
	void sweep(std::vector<Candidate>& candidates, Real unnoticed);
	void limit(Real allowedDisplacement);
	void holdBack(std::vector<Candidate>& candidates, Real allowed);
};

} // namespace yade
