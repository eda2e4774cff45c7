// SPDX-License-Identifier: GPL-2.0-or-later
#include "FclibHeader.hpp"
#include "Problem.hpp"
#include "Reduction.hpp"

#include <cstdlib>
#include <filesystem>
#include <memory>

namespace contactdynamics::fclib {

namespace {

/// libfclib deletes what a problem holds, but not the problem.
struct Delete {
	void operator()(fclib_local* problem) const
	{
		fclib_delete_local(problem);
		std::free(problem);
	}
	void operator()(fclib_global* problem) const
	{
		fclib_delete_global(problem);
		std::free(problem);
	}
};

/// Triplets: libfclib's header calls p the rows and i the columns; the files that there are, written with CSparse, have it the other way round.
Sparse sparse(const fclib_matrix& from)
{
	std::vector<Eigen::Triplet<double>> entries;
	if (from.nz >= 0)
		for (int k = 0; k < from.nz; ++k) entries.emplace_back(from.i[k], from.p[k], from.x[k]);
	else
		for (int line = 0; line < (from.nz == -1 ? from.n : from.m); ++line)
			for (int k = from.p[line]; k < from.p[line + 1]; ++k)
				from.nz == -1 ? entries.emplace_back(from.i[k], line, from.x[k]) : entries.emplace_back(line, from.i[k], from.x[k]);
	Sparse matrix(from.m, from.n);
	matrix.setFromTriplets(entries.begin(), entries.end()); // sorts, and adds what is there twice
	return matrix;
}

Eigen::VectorXd vector(const double* values, Eigen::Index size) { return Eigen::Map<const Eigen::VectorXd>(values, size); }

std::vector<double> frictionOf(const double* mu, int components, int dimension) { return {mu, mu + components / dimension}; }

void readLocal(const std::string& path, Problem& problem)
{
	const std::unique_ptr<fclib_local, Delete> file(fclib_read_local(path.c_str()));
	if (!file) throw FileError(path + ": libfclib cannot read /fclib_local");
	Reduced reduced{sparse(*file->W), vector(file->q, file->W->m)};
	if (file->V) {
		problem.constraints = file->R->m;
		// R l = -V^T r - s,  u = W r + V l + q
		const Sparse V = sparse(*file->V);
		try {
			const Reduced part = eliminate(sparse(*file->R), -Sparse(V.transpose()), -vector(file->s, V.cols()), Sparse(V.transpose()), reduced.q);
			reduced = {Sparse(reduced.W + part.W), part.q};
		} catch (const std::domain_error& singular) {
			throw FileError(path + ": dataset /fclib_local/R " + singular.what() + ", so the equality constraints cannot be eliminated");
		}
	}
	problem.local = blocksOf(file->spacedim, reduced.W, reduced.q, frictionOf(file->mu, file->W->m, file->spacedim));
}

void readGlobal(const std::string& path, Problem& problem)
{
	const std::unique_ptr<fclib_global, Delete> file(fclib_read_global(path.c_str()));
	if (!file) throw FileError(path + ": libfclib cannot read /fclib_global");
	Sparse K = sparse(*file->M), H = sparse(*file->H);
	Eigen::VectorXd c = vector(file->f, K.rows());
	problem.unknowns = file->M->m;
	if (file->G) {
		// M v - G l = H r + f,  G^T v = -b
		problem.constraints = file->G->n;
		const Sparse G = sparse(*file->G);
		K = bordered(K, -G, Sparse(G.transpose()));
		c.conservativeResize(K.rows());
		c.tail(G.cols()) = -vector(file->b, G.cols());
		H.conservativeResize(K.rows(), H.cols());
	}
	try {
		const Reduced reduced = eliminate(K, H, c, H, vector(file->w, H.cols()));
		problem.local = blocksOf(file->spacedim, reduced.W, reduced.q, frictionOf(file->mu, file->H->n, file->spacedim));
	} catch (const std::domain_error& singular) {
		throw FileError(path + ": dataset /fclib_global/M " + (file->G ? "with the constraints G " : "") + singular.what() +
						", so the velocities cannot be eliminated");
	}
}

} // namespace

Problem readProblem(const std::string& path)
{
	Problem problem;
	problem.name = std::filesystem::path(path).stem().string();
	{
		const Hdf5File file(path);
		problem.form = requireProblem(file);
		const std::string title = problem.form == Form::local ? "/fclib_local/info/title" : "/fclib_global/info/title";
		if (file.has(title)) problem.title = file.text(title);
	}
	problem.form == Form::local ? readLocal(path, problem) : readGlobal(path, problem);
	return problem;
}

std::vector<double> readSolution(const std::string& path)
{
	const Hdf5File file(path);
	return requireSolution(file, requireProblem(file)) ? file.reals("/solution/r") : std::vector<double>();
}

} // namespace contactdynamics::fclib
