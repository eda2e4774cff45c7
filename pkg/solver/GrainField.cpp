// SPDX-License-Identifier: GPL-2.0-or-later
// The mean field of a problem: a body that every contact acts on, and so no colour of contacts can have to itself.
#include "GrainOperator.hpp"

namespace contactdynamics {

/// Within a sweep the contacts see the L of its start, whoever visits them: Gauss-Seidel in the bodies, Jacobi in the mean field. What that omits is
/// an operator of rank 6 at most, b b^T / M for each two contacts. It is as large as N b^2/M for the isotropic mode of N bodies with the three
/// contacts each of a rigid packing (a third of N_c b^2/M, the mean of (n.n')^2), so contacts step as if their own W were at least that: with a heavy
/// mean field, M >= sum of m b^2, no change; with a light one the sweeps become short, and converge all the same. Rejected: L updated by every
/// contact, which orders all contacts; L solved for outside of the sweeps, at fixed L: a jammed packing that L compresses has no solution.
void GrainOperator::startField()
{
	moment.setZero();
	fieldStep = 0;
	if (!hasField()) return;
	gradient = problem->meanField->gradientWith(moment);
	std::size_t count = 0;
	for (const std::uint8_t moves : movable) count += moves;
	fieldStep = double(count) * problem->meanField->inverseMass.maxCoeff();
}

double GrainOperator::mobility(double W, const Contact& c) const { return std::max(W, fieldStep * (c.arm1 - c.arm2).squaredNorm()); }

void GrainOperator::startFieldPass(Extrapolation by)
{
	if (accelerated) {
		const Matrix3 last = moment - momentStart, ahead = by.relax * last + by.momentum * momentDirection;
		momentDirection = last + ahead;
		momentStart = moment += ahead;
	}
	gradient = problem->meanField->gradientWith(moment);
	FieldPass pass{};
	for (int i = 0; i < 9; ++i) pass.gradient[i] = gradient(i / 3, i % 3);
	chunkFields.assign(chunks.size(), pass);
}

void GrainOperator::addFieldPasses()
{
	for (const FieldPass& pass : chunkFields)
		for (int i = 0; i < 9; ++i) moment(i / 3, i % 3) += pass.moment[i];
	gradient = problem->meanField->gradientWith(moment);
}

/// From the impulses themselves: no drift of the sweeps is left in it.
void GrainOperator::sumMoment()
{
	const auto& contacts = problem->contacts;
	runMoments.assign((contacts.size() + perRun - 1) / perRun, Matrix3::Zero());
	inRuns(contacts.size(), [&](std::size_t i) {
		if (!impulses[i].isZero(0)) runMoments[i / perRun] += impulses[i] * (contacts[i].arm1 - contacts[i].arm2).transpose();
	});
	moment.setZero();
	for (const Matrix3& one : runMoments) moment += one;
	gradient = problem->meanField->gradientWith(moment);
}

} // namespace contactdynamics
