#!/bin/sh
# Fetches the source of zstd, as Debian has it, and unpacks it: `zstd_source.sh FOLDER` leaves FOLDER/lib. The lists of
# sources of the system stay as they are.
set -eu
folder=$1
[ ! -e "$folder/lib/zstd.h" ] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$folder"
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=${FRAMELET_MIRROR:-http://deb.debian.org/debian}
cat > "$work/list.sources" <<END
Types: deb-src
URIs: $mirror
Suites: $suite
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
cd "$work"
get() {
  apt-get -qq -o Dir::Etc::SourceParts=/dev/null -o Dir::Etc::SourceList="$work/list.sources" \
    -o Dir::State::Lists="$work/lists" -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" "$@"
}
get update
get source --download-only libzstd
tar -xf "$(ls libzstd_*.orig.tar.?z)" -C "$folder" --strip-components=1
