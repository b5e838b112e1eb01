#!/usr/bin/env bash
# Installs everything that building, testing and the demo need, from Debian's own packages.
# Works as root and, with sudo, as a user. Does nothing where all is there already.
#   scripts/install-deps.sh         for the release build
#   scripts/install-deps.sh asan    for the sanitized builds, too (asan, tsan)
#   scripts/install-deps.sh package for Debian packages, too
#   scripts/install-deps.sh browser for tests of pages in a browser, too
set -euo pipefail

packages=(
    # build
    g++ cmake ninja-build ccache
    libmrpt-dev libeigen3-dev libcli11-dev nlohmann-json3-dev libnanoflann-dev liboctomap-dev
    zlib1g-dev libceres-dev
    # Python package, its reports and pages, its tests and its wheel
    pybind11-dev python3-dev python3-numpy python3-pytest
    python3-setuptools python3-wheel python3-build python3-matplotlib
    libjs-three python3-distributed
    # the planner's example
    libompl-dev libdynamicedt3d-dev
    # tests
    libgtest-dev libbenchmark-dev clang-format pkg-config
    # stock MRPT apps and their data, used by the tests and the demo
    mrpt-apps mrpt-common
)
if [[ ${1:-} == asan || ${1:-} == tsan ]]; then
    # Sanitized, GCC takes longer to compile the code, and the code to run.
    packages+=(clang clang-tidy libclang-rt-dev libomp-dev llvm)
fi
if [[ ${1:-} == browser ]]; then
    packages+=(chromium chromium-driver python3-selenium)
fi
if [[ ${1:-} == package ]]; then
    packages+=(dpkg-dev file gzip help2man lintian man-db)
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
    [[ $state == "install ok installed" ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    exit 0
fi

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || {
        echo "install-deps.sh: needs root or sudo to install: ${missing[*]}" >&2
        exit 1
    }
    as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
