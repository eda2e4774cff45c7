// SPDX-License-Identifier: GPL-2.0-or-later
#include "NewtonFinish.hpp"

namespace contactdynamics {

namespace {
constexpr double firstDamping = 1e-3, leastDamping = 1e-13, mostDamping = 100;
} // namespace

template <int D> int NewtonFinish<D>::improve(CertifiedPoint<D>& best, double tolerance, int steps)
{
	const CertifiedPoint<D> start = best;
	int done = swept(best, tolerance, steps / 4);
	if (best.residual <= tolerance) return done;
	// The swept steps may have ended where the search cannot leave, so it starts where they did.
	CertifiedPoint<D> other = start;
	done += searched(other, tolerance, steps - done);
	if (other.residual < best.residual) best = other;
	return done;
}

template <int D> void NewtonFinish<D>::certify(CertifiedPoint<D>& best, double tolerance)
{
	const double residual = blocks.certificate();
	if (!(residual < best.residual) || blocks.crushed(tolerance).any()) return;
	best.residual = residual;
	blocks.impulses(best.impulses);
}

template <int D> int NewtonFinish<D>::swept(CertifiedPoint<D>& best, double tolerance, int steps)
{
	double damping = firstDamping;
	blocks.setRaw(best.impulses);
	for (int done = 1; done <= steps; ++done) {
		blocks.velocities(velocity);
		blocks.impulses(point);
		if (!step.compute(point, velocity, damping, next)) return done;
		blocks.setImpulses(next);
		certify(best, tolerance);
		if (best.residual <= tolerance) return done;
		blocks.sweep({});
		blocks.sweep({});
		const double residual = blocks.certificate();
		if (!std::isfinite(residual)) return done;
		certify(best, tolerance);
		if (best.residual <= tolerance) return done;
		damping = std::max(leastDamping, 0.3 * std::min(damping, residual));
	}
	return steps;
}

template <int D> int NewtonFinish<D>::searched(CertifiedPoint<D>& best, double tolerance, int steps)
{
	constexpr int halvings = 6;
	constexpr double enough = 1e-4; // of Armijo's rule
	double damping = firstDamping;
	point = best.impulses;
	trial.resize(point.size());
	blocks.setRaw(point);
	blocks.velocities(velocity);
	double merit = step.merit(point, velocity);
	for (int done = 1; done <= steps; ++done) {
		if (!step.compute(point, velocity, damping, next)) {
			damping *= 100;
			if (damping > mostDamping) return done;
			continue;
		}
		bool accepted = false;
		double length = 1;
		for (int i = 0; i <= halvings && !accepted; ++i, length *= 0.5) {
			for (std::size_t c = 0; c < point.size(); ++c) trial[c] = point[c] + length * (next[c] - point[c]);
			blocks.setRaw(trial);
			blocks.velocities(trialVelocity);
			const double trialMerit = step.merit(trial, trialVelocity);
			if (!(trialMerit < (1 - enough * length) * merit)) continue;
			accepted = true;
			merit = trialMerit;
			point = trial;
			velocity.swap(trialVelocity);
			blocks.setImpulses(point);
			certify(best, tolerance);
			if (best.residual <= tolerance) return done;
		}
		if (!accepted)
			damping *= 10;
		else if (length >= 0.25) // halved once more by the loop
			damping = std::max(leastDamping, 0.2 * damping);
		if (damping > mostDamping) return done;
	}
	return steps;
}

template class NewtonFinish<2>;
template class NewtonFinish<3>;

} // namespace contactdynamics
