// SPDX-License-Identifier: GPL-2.0-or-later
// The program behind scripts/fclib.
#include "SolveFiles.hpp"

#include <cstdio>

int main(int count, char** words)
{
	using namespace contactdynamics::fclib;
	try {
		const Arguments arguments = parse({words + 1, words + count});
		if (arguments.help) {
			std::fputs(usage, stdout);
			return 0;
		}
		return (arguments.solve ? solveFiles(arguments) : showFiles(arguments)) ? 0 : 1;
	} catch (const UsageError& error) {
		std::fprintf(stderr, "error: %s\n\n%s", error.what(), usage);
		return 2;
	}
}
