# SPDX-License-Identifier: GPL-2.0-or-later
# Finds the installed YADE and asks it what it is.
#   YADE_EXECUTABLE      the program; may be given
#   YADE_LIBRARY_DIR     directory of libyade.so
#   YADE_PYTHON, YADE_PYTHON_INCLUDE, YADE_PYTHON_LIBRARY, YADE_PYTHON_VERSION   the interpreter it runs on, where Python.h is, its library, "311"
#   YADE_VERSION, YADE_BITS, YADE_FEATURES                  from its yade.config

find_program(YADE_EXECUTABLE NAMES yade DOC "The yade program to build for")
if(NOT YADE_EXECUTABLE)
	message(FATAL_ERROR "No program `yade` found. Install it (apt-get install yade), or pass -DYADE_EXECUTABLE=<path>.")
endif()

# The program is a Python script: its first line names the interpreter (not the `python3` of the PATH, which may be another one), and a later one the
# directory of the package.
file(STRINGS ${YADE_EXECUTABLE} shebang LIMIT_COUNT 1)
string(REGEX REPLACE "^#! *([^ ]+).*$" "\\1" YADE_PYTHON "${shebang}")
file(STRINGS ${YADE_EXECUTABLE} path_line REGEX "^sys\\.path\\.insert\\(1,'.*/py'\\)" LIMIT_COUNT 1)
string(REGEX REPLACE "^.*'(.*)/py'.*$" "\\1" YADE_LIBRARY_DIR "${path_line}")
if(NOT EXISTS "${YADE_PYTHON}" OR NOT EXISTS "${YADE_LIBRARY_DIR}/py/yade/config.py")
	message(FATAL_ERROR "${YADE_EXECUTABLE} does not look like YADE's program: no interpreter in its first line, or no directory of its Python package in it.")
endif()

# config.py alone: importing all of YADE here would start its threads and need a display.
set(ask [[
import runpy, sys, sysconfig
config = runpy.run_path(sys.argv[1])
print(sysconfig.get_path("include"), "%d%d" % sys.version_info[:2], config["version"], config["highPrecisionBits"], ",".join(config["features"]),
      sysconfig.get_config_var("LIBDIR") + "/" + sysconfig.get_config_var("LDLIBRARY"), sep=";")
]])
execute_process(
	COMMAND ${YADE_PYTHON} -c "${ask}" ${YADE_LIBRARY_DIR}/py/yade/config.py
	OUTPUT_VARIABLE answer
	OUTPUT_STRIP_TRAILING_WHITESPACE
	RESULT_VARIABLE failed
)
if(failed)
	message(FATAL_ERROR "${YADE_PYTHON} could not read ${YADE_LIBRARY_DIR}/py/yade/config.py.")
endif()
list(GET answer 0 YADE_PYTHON_INCLUDE)
list(GET answer 1 YADE_PYTHON_VERSION)
list(GET answer 2 YADE_VERSION)
list(GET answer 3 YADE_BITS)
list(GET answer 4 YADE_FEATURES)
list(GET answer 5 YADE_PYTHON_LIBRARY)
string(REPLACE "," ";" YADE_FEATURES "${YADE_FEATURES}")
if(NOT EXISTS ${YADE_PYTHON_INCLUDE}/Python.h)
	message(FATAL_ERROR "No Python.h in ${YADE_PYTHON_INCLUDE}: install the headers of ${YADE_PYTHON} (apt-get install libpython3-dev).")
endif()
message(STATUS "YADE ${YADE_VERSION}, ${YADE_BITS} bits, in ${YADE_LIBRARY_DIR}")
