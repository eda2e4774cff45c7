// SPDX-License-Identifier: GPL-2.0-or-later
#include "Problem.hpp"
#include "Reduction.hpp"
#include "SolveFiles.hpp"

#include <algorithm>
#include <cstdio>

namespace contactdynamics::fclib {

namespace {

void show(const std::string& path, const Problem& problem)
{
	const BlockProblem& local = problem.local;
	std::printf("%s\n", path.c_str());
	if (!problem.title.empty()) std::printf("  title         %s\n", problem.title.c_str());
	std::printf("  form          %s, %dD, %zu contacts", problem.form == Form::local ? "local" : "global", local.dimension, local.contacts());
	if (problem.form == Form::global) std::printf(", %d velocities", problem.unknowns);
	if (problem.constraints) std::printf(", %d equality constraints", problem.constraints);
	std::printf("\n");
	if (local.contacts() == 0) return;
	const auto [least, most] = std::minmax_element(local.friction.begin(), local.friction.end());
	std::printf("  friction      %g ... %g\n", *least, *most);
	const Sparse W = matrixOf(local), difference = W - Sparse(W.transpose());
	const double size = W.coeffs().cwiseAbs().maxCoeff();
	std::printf("  W             %zu blocks, %.1f per contact; largest entry %g, asymmetry %.1e of it\n", local.column.size(),
				double(local.column.size()) / double(local.contacts()), size,
				size > 0 && difference.nonZeros() ? difference.coeffs().cwiseAbs().maxCoeff() / size : 0);
}

void showSolution(BlockProblem problem, const std::vector<double>& impulses)
{
	if (impulses.empty()) {
		std::printf("  solution      none\n");
		return;
	}
	problem.impulse = impulses;
	std::printf("  solution      error %.3e as Siconos defines it, relative natural map %.3e\n", residualOf(problem, Measure::siconos),
				residualOf(problem, Measure::naturalMap));
}

} // namespace

bool showFiles(const Arguments& arguments)
{
	bool allWell = true;
	for (const std::string& path : arguments.files) {
		try {
			const Problem problem = readProblem(path);
			show(path, problem);
			showSolution(problem.local, readSolution(path));
		} catch (const std::exception& error) {
			std::fprintf(stderr, "error: %s\n", error.what());
			allWell = false;
		}
	}
	return allWell;
}

} // namespace contactdynamics::fclib
