#!/usr/bin/env bash
# Builds the Debian packages: build/package/*.deb. The same commit gives the same bytes where the system is the same.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cmake/install_packages.sh --programs packages_web.txt
umask 022
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)
export SOURCE_DATE_EPOCH
cmake --preset web
cmake --build --preset web --target page
cmake --preset package
cmake --build --preset package
cd build/package
rm -f ./*.deb
cpack
rm -rf _CPack_Packages
