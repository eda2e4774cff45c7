// SPDX-License-Identifier: GPL-2.0-or-later
#include "SolveFiles.hpp"

#include "Problem.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>

namespace contactdynamics::fclib {

namespace {

struct Result {
	std::string name;
	int dimension;
	std::size_t contacts;
	SolveReport report;
	double seconds;
	double error;
};

const char* verdict(const Result& result)
{
	switch (result.report.status) {
	case SolveStatus::converged:
		return "converged";
	case SolveStatus::maxIterations:
		return "not converged";
	case SolveStatus::notFinite:
		return "not finite";
	case SolveStatus::unbounded:
		return "no solution: impulses grow without bound";
	}
	return "unknown";
}

/// Solves once, and again while the whole takes less than a few milliseconds: the first solve of a small problem measures the cold caches.
/// Each starts from zero, so that all give the same bits.
Result solved(Problem& problem, const SolverOptions& options)
{
	Result result{problem.name, problem.local.dimension, problem.local.contacts(), {}, std::numeric_limits<double>::infinity(), 0};
	double total = 0;
	for (int run = 0; run < 5 && total < 5e-3; ++run) {
		std::fill(problem.local.impulse.begin(), problem.local.impulse.end(), 0);
		const auto start = std::chrono::steady_clock::now();
		result.report = solve(problem.local, options, Measure::siconos);
		const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
		result.seconds = std::min(result.seconds, seconds);
		total += seconds;
	}
	// Not the solver's own word, but evaluated anew at the point it returned.
	result.error = residualOf(problem.local, Measure::siconos);
	return result;
}

bool converged(const Result& result, double tolerance) { return result.report.status == SolveStatus::converged && result.error <= tolerance; }

std::string quoted(const std::string& text)
{
	std::string result = "\"";
	for (const char c : text) {
		char code[8];
		if (c == '"' || c == '\\')
			result += {'\\', c};
		else if (static_cast<unsigned char>(c) < 0x20) {
			std::snprintf(code, sizeof code, "\\u%04x", c);
			result += code;
		} else
			result += c;
	}
	return result + '"';
}

void writeJson(const std::string& path, const std::vector<Result>& results, double tolerance)
{
	std::ofstream out(path);
	out << std::setprecision(17) << "[";
	const char* separator = "\n";
	for (const Result& result : results) {
		out << separator << "{\"problem\": " << quoted(result.name) << ", \"dimension\": " << result.dimension
			<< ", \"contacts\": " << result.contacts << ", \"tolerance\": " << tolerance << ", \"iterations\": " << result.report.iterations
			<< ", \"seconds\": " << result.seconds << ", \"error\": ";
		std::isfinite(result.error) ? out << result.error : out << "null"; // JSON knows no infinity
		out << ", \"converged\": " << (converged(result, tolerance) ? "true" : "false") << "}";
		separator = ",\n";
	}
	out << "\n]\n";
	out.close();
	if (!out) throw FileError(path + ": cannot be written");
}

std::filesystem::path target(const Arguments& arguments, const std::string& file)
{
	return std::filesystem::path(arguments.folder) / std::filesystem::path(file).stem().concat(".hdf5");
}

/// What would be written must not replace what is read, nor one another.
void requireOwnTargets(const Arguments& arguments)
{
	const auto requireNoInput = [&](const char* option, const std::filesystem::path& path) {
		for (const std::string& input : arguments.files)
			if (std::error_code none; std::filesystem::equivalent(path, input, none))
				throw UsageError(std::string(option) + " would replace " + input + ", which is to be read; write elsewhere");
	};
	if (!arguments.json.empty()) requireNoInput("--json", arguments.json);
	if (arguments.folder.empty()) return;
	std::map<std::filesystem::path, std::string> sources;
	for (const std::string& file : arguments.files) {
		const std::filesystem::path path = target(arguments, file);
		requireNoInput("--write", path);
		const auto [known, isNew] = sources.emplace(path, file);
		if (!isNew) throw UsageError("--write would put both " + known->second + " and " + file + " into " + path.string() + "; write one at a time");
	}
}

/// Hours of solving should not end at a folder that does not exist.
void requireWritable(const Arguments& arguments)
{
	std::error_code failed;
	if (!arguments.folder.empty()) std::filesystem::create_directories(arguments.folder, failed);
	if (failed) throw FileError(arguments.folder + ": cannot be made: " + failed.message());
	if (!arguments.json.empty() && !std::ofstream(arguments.json, std::ios::app)) throw FileError(arguments.json + ": cannot be written");
}

/// False, for the exit code.
bool complain(const std::exception& error)
{
	std::fprintf(stderr, "error: %s\n", error.what());
	return false;
}

} // namespace

bool solveFiles(const Arguments& arguments)
{
	requireOwnTargets(arguments);
	try {
		requireWritable(arguments);
	} catch (const FileError& error) {
		return complain(error);
	}
	const double tolerance = arguments.options.tolerance;
	bool allWell = true;
	std::vector<Result> results;
	int width = 7;
	for (const std::string& path : arguments.files) width = std::max(width, int(std::filesystem::path(path).stem().string().size()));
	std::printf("%-*s dim contacts iterations    seconds      error  status (tolerance %g)\n", width, "problem", tolerance);
	for (const std::string& path : arguments.files) {
		try {
			Problem problem = readProblem(path);
			const Result result = solved(problem, arguments.options);
			std::printf("%-*s %3d %8zu %10d %10.3e %10.3e  %s\n", width, result.name.c_str(), result.dimension, result.contacts,
						result.report.iterations, result.seconds, result.error, verdict(result));
			std::fflush(stdout);
			results.push_back(result);
			if (!arguments.folder.empty()) writeProblem(target(arguments, path).string(), problem);
		} catch (const std::exception& error) {
			allWell = complain(error);
		}
	}
	try {
		if (!arguments.json.empty()) writeJson(arguments.json, results, tolerance);
	} catch (const FileError& error) {
		allWell = complain(error);
	}
	return allWell;
}

} // namespace contactdynamics::fclib
