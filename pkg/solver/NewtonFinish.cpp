// SPDX-License-Identifier: GPL-2.0-or-later
#include "NewtonFinish.hpp"

namespace contactdynamics {

namespace {
constexpr double firstDamping = 1e-3, leastDamping = 1e-13;
constexpr int mostSteps = 15; // where it works at all it takes at most ten
} // namespace

template <int D> int NewtonFinish<D>::improve(CertifiedPoint<D>& best, double tolerance)
{
	double damping = firstDamping;
	blocks.setRaw(best.impulses);
	for (int done = 1; done <= mostSteps; ++done) {
		blocks.velocities(velocity);
		blocks.impulses(point);
		if (!step.compute(point, velocity, damping, next)) return done;
		blocks.setImpulses(next);
		certify(blocks, best);
		if (best.residual <= tolerance) return done;
		blocks.sweep({});
		blocks.sweep({});
		const double residual = blocks.certificate();
		if (!std::isfinite(residual)) return done;
		certify(blocks, best);
		if (best.residual <= tolerance) return done;
		damping = std::max(leastDamping, 0.3 * std::min(damping, residual));
	}
	return mostSteps;
}

template class NewtonFinish<2>;
template class NewtonFinish<3>;

} // namespace contactdynamics
