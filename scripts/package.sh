#!/usr/bin/env bash
# Makes Debian packages for the release of Debian that it runs in, and looks at them with lintian.
#   scripts/package.sh [FOLDER]     also copies them to FOLDER; they are in build-package/debs
# DEBFULLNAME and DEBEMAIL name the maintainer, as for Debian's own tools.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh package
umask 022
# Packages of one commit are the same bytes.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)}
export SOURCE_DATE_EPOCH
cmake --preset package >/dev/null
cmake --build --preset package
rm -rf build-package/debs
cpack --config build-package/CPackConfig.cmake -B build-package/debs
rm -rf build-package/debs/_CPack_Packages
lintian --allow-root --fail-on error build-package/debs/*.deb
if [[ -n ${1:-} ]]; then
    mkdir -p "$1"
    cp build-package/debs/*.deb "$1"
fi
