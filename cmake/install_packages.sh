#!/usr/bin/env bash
# Installs the Debian packages that are missing of packages_viewer.txt, packages.txt, packages_tests.txt and the lists
# named as arguments, all in this folder; with --viewer of the first alone, with --programs of the first two and those
# lists. Quiet and quick where none is missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case "${1:-}" in
--viewer) lists=(packages_viewer.txt) ;;
--programs) lists=(packages_viewer.txt packages.txt "${@:2}") ;;
*) lists=(packages_viewer.txt packages.txt packages_tests.txt "$@") ;;
esac
missing=()
while read -r package; do
    if ! dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed'; then
        missing+=("$package")
    fi
done < <(cat "${lists[@]/#/$here/}" | grep -v '^#' | grep -v '^$')
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing ${#missing[@]} Debian packages, which may take a minute or two: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "these packages are missing and only root can install them: ${missing[*]}" >&2
        exit 1
    }
    as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
