# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash disable=SC2034  # the lists are read by the scripts that source this file
# Shared by quickstart, test, bench and docs: what to install, how to build, how to start YADE. Sourced, never run.

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

# One list of Debian packages for every script, so that a machine that ran one of them can run all of them.
BUILD_PACKAGES=(cmake g++ make libboost-python-dev libboost-serialization-dev libeigen3-dev python3-dev libgtest-dev libfclib-dev libcgal-dev)
RUN_PACKAGES=(yade python3-h5py python3-numpy python3-matplotlib python3-pil python3-tqdm)
TEST_PACKAGES=(python3-pytest)
DOC_PACKAGES=(python3-sphinx)
BENCH_PACKAGES=(libbenchmark-dev)

say() { printf '\n==> %s\n' "$*"; }
fail() {
	printf '\nerror: %s\n' "$*" >&2
	exit 1
}

missing_packages() {
	local package
	for package in "$@"; do
		dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || echo "$package"
	done
}

# Installs only what is missing, so a user without root can run every script once the packages are there.
install_packages() {
	command -v dpkg-query >/dev/null || fail "this script installs Debian packages; elsewhere build with plain CMake (see README.md)"
	local missing as_root=()
	mapfile -t missing < <(missing_packages "$@")
	if [ ${#missing[@]} -eq 0 ]; then
		say "Packages: all $# installed"
		return
	fi
	say "Packages: installing ${missing[*]}"
	if [ "$(id -u)" -ne 0 ]; then
		as_root=(sudo -n)
		sudo -n true 2>/dev/null || fail "root is needed once; run: sudo apt-get install ${missing[*]}"
	fi
	# The lock timeout lets a machine finish its own automatic upgrade first.
	local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600)
	"${apt[@]}" update || echo "apt-get update failed; trying with the package lists already here"
	"${apt[@]}" install -y --no-install-recommends "${missing[@]}" </dev/null || fail "apt-get could not install ${missing[*]}"
}

# Each compile job takes up to a gigabyte, so there are no more jobs than processors or gigabytes free.
build_jobs() {
	awk -v jobs="$(nproc)" '/^MemAvailable/ {free = int($2 / 1048576); print free < 1 ? 1 : free < jobs ? free : jobs}' /proc/meminfo
}

build_preset() {
	say "Build: preset $1"
	(cd "$ROOT" && cmake --preset "$1" && cmake --build --preset "$1" -j "$(build_jobs)") || fail "the build of preset $1 failed"
}

# Runs a command in the environment of a user of the fresh build. An inherited display or thread count must not change the results.
with_plugin() {
	env -u DISPLAY -u OMP_NUM_THREADS PYTHONPATH="$ROOT/build/python${PYTHONPATH:+:$PYTHONPATH}" PYTHONUNBUFFERED=1 MPLBACKEND=Agg \
		"$@" </dev/null
}

# Stock YADE without a window, with the fresh build; one thread unless the caller says -jN.
run_yade() { with_plugin yade -n "$@"; }
