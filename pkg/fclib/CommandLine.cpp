// SPDX-License-Identifier: GPL-2.0-or-later
#include "CommandLine.hpp"

#include <charconv>
#include <cmath>

namespace contactdynamics::fclib {

const char* const usage =
		R"(Usage: scripts/fclib solve [--tolerance T] [--max-iterations N] [--threads K] [--acceleration A] [--json OUT] [--write FOLDER] FILE...
       scripts/fclib info FILE...

solve  Solves each contact problem (FCLIB, HDF5) from zero impulses, and prints a table.
  --tolerance T        bound on the error at which to stop, > 0 (default 1e-4)
  --max-iterations N   sweeps allowed, >= 0 (default 100000)
  --threads K          >= 1 (default 1); explicit blocks are swept in their order, by one thread whatever K is
  --acceleration A     none (plain nonlinear Gauss-Seidel) or momentum (default)
  --json OUT           also write the results as a list of {"problem", "dimension", "contacts", "tolerance", "iterations", "seconds", "error", "converged"}
  --write FOLDER       also write each problem, reduced to local form, with the solution found, to FOLDER/NAME.hdf5; refused where that is one of the
                       files read, or the same for two of them
info   Says what is in each file.

error    Siconos's: with u = W r + q and P the projection on the Coulomb cone, sqrt(sum |r - P(r - u - mu |u_T| n)|^2) / max(|q|, |r|, |u|), not divided if
         the maximum is <= 2.2e-16, at the point returned. It adds impulses to velocities, so it depends on units; it is here for comparisons.
seconds  the solve alone, without reading; the fastest of up to five when one takes less than a few milliseconds
Exit code: 0 when every file was read, converged or not; 1 when one could not be read or written; 2 for wrong usage.
)";

namespace {

template <class Number> Number number(const std::string& option, const std::string& word, const char* allowed)
{
	Number value{};
	const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
	if (error != std::errc() || end != word.data() + word.size()) throw UsageError(option + " is '" + word + "', must be " + allowed);
	return value;
}

Acceleration accelerationOf(const std::string& name)
{
	if (name == "none") return Acceleration::none;
	if (name == "momentum") return Acceleration::momentum;
	throw UsageError("--acceleration is '" + name + "', must be none or momentum");
}

} // namespace

Arguments parse(const std::vector<std::string>& words)
{
	Arguments arguments;
	arguments.options.maxIterations = 100000;
	if (words.empty()) throw UsageError("solve or info must be said");
	arguments.help = words[0] == "--help" || words[0] == "-h";
	arguments.solve = words[0] == "solve";
	if (!arguments.solve && !arguments.help && words[0] != "info") throw UsageError("'" + words[0] + "' is neither solve nor info");
	for (std::size_t k = 1; k < words.size(); ++k) {
		const std::string& word = words[k];
		if (word == "--help" || word == "-h") {
			arguments.help = true;
			continue;
		}
		if (word.size() < 2 || word[0] != '-') {
			arguments.files.push_back(word);
			continue;
		}
		const bool known = word == "--tolerance" || word == "--max-iterations" || word == "--threads" || word == "--acceleration" ||
						   word == "--json" || word == "--write";
		if (!known || !arguments.solve) throw UsageError("'" + word + "' is no option of " + words[0]);
		if (++k == words.size()) throw UsageError(word + " needs a value");
		const std::string& value = words[k];
		if (word == "--tolerance") {
			const double tolerance = number<double>(word, value, "a number > 0");
			if (!(tolerance > 0 && std::isfinite(tolerance))) throw UsageError("--tolerance is '" + value + "', must be a number > 0");
			arguments.options.tolerance = tolerance;
		} else if (word == "--max-iterations")
			arguments.options.maxIterations = number<int>(word, value, "an integer >= 0");
		else if (word == "--threads")
			arguments.options.threads = number<int>(word, value, "an integer >= 1");
		else if (word == "--acceleration")
			arguments.options.acceleration = accelerationOf(value);
		else if (word == "--json")
			arguments.json = value;
		else
			arguments.folder = value;
	}
	if (arguments.options.maxIterations < 0) throw UsageError("--max-iterations must be an integer >= 0");
	if (arguments.options.threads < 1) throw UsageError("--threads must be an integer >= 1");
	if (arguments.files.empty() && !arguments.help) throw UsageError(words[0] + " needs at least one file");
	return arguments;
}

} // namespace contactdynamics::fclib
