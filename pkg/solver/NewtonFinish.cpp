// SPDX-License-Identifier: GPL-2.0-or-later
#include "NewtonFinish.hpp"

namespace contactdynamics {

namespace {
constexpr double firstDamping = 1e-3, leastDamping = 1e-13;
constexpr int mostSteps = 15; // where it works at all it takes three to twelve
} // namespace

template <int D> int NewtonFinish<D>::improve(CertifiedPoint<D>& best, double tolerance, int most)
{
	double damping = firstDamping;
	blocks.setRaw(best.impulses);
	most = std::min(most, mostSteps);
	for (int done = 1; done <= most; ++done) {
		blocks.velocities(velocity);
		blocks.impulses(point);
		if (!step.compute(point, velocity, damping, next)) return done;
		blocks.setImpulses(next);
		const double residual = certify(blocks, best);
		if (best.residual <= tolerance || !std::isfinite(residual)) return done;
		blocks.setRaw(next);
		damping = std::max(leastDamping, 0.3 * std::min(damping, residual));
	}
	return most;
}

template class NewtonFinish<2>;
template class NewtonFinish<3>;

} // namespace contactdynamics
