// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlocksApart.hpp"

#include "BlockResidual.hpp"
#include "OneContact.hpp"
#include "OneContact2D.hpp"
#include "ProblemBlocks.hpp"

#include <algorithm>
#include <type_traits>

namespace contactdynamics {

template <int D> bool solveApart(BlockProblem& problem, const SolverOptions& options, Measure measure, SolveReport& report)
{
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;
	using Local = std::conditional_t<D == 2, OneContact2D, OneContact>;
	const std::size_t count = problem.contacts();
	if (problem.column.size() != count || options.maxIterations == 0) return false;
	for (const double r : problem.impulse)
		if (r != 0) return false; // a start worth trying
	SolveReport done;
	done.iterations = 1;
	BlockResidual<D> residual(measure);
	problem.velocity.resize(problem.q.size());
	const auto at = [](std::vector<double>& values, std::size_t i) { return Eigen::Map<Vector>(&values[D * i]); };
	for (std::size_t i = 0; i < count; ++i) {
		// One block in each row, and every row has its diagonal block.
		const Block W = blockOf<D>(problem, int(i));
		const Block symmetric = 0.5 * (W + W.transpose());
		const Vector q = at(problem.q, i);
		const Local local(symmetric);
		const Vector r = local.solve(q, problem.friction[i]), u = W * r + q;
		residual.add(r, u, q, problem.friction[i], symmetric);
		at(problem.impulse, i) = r;
		at(problem.velocity, i) = u;
		done.maxApproachSpeed = std::max(done.maxApproachSpeed, -u[0]);
		done.activeContacts += r[0] > 0;
		if constexpr (D == 2) done.ambiguousContacts += !local.isUnique(problem.friction[i]);
	}
	done.residual = residual.value();
	if (done.residual <= options.tolerance) {
		report = done;
		return true;
	}
	std::fill(problem.impulse.begin(), problem.impulse.end(), 0);
	return false;
}

template bool solveApart<2>(BlockProblem&, const SolverOptions&, Measure, SolveReport&);
template bool solveApart<3>(BlockProblem&, const SolverOptions&, Measure, SolveReport&);

} // namespace contactdynamics
