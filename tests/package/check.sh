#!/usr/bin/env bash
# Installs the packages of build/package into a fresh system and uses them there (inside.sh), and looks whether they say
# so on a processor that is too old. Needs root, and some 700 MB in a temporary folder. What the window showed is
# build/package/view.xwd.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
packages=$root/build/package
[ "$(id -u)" -eq 0 ] || {
    echo "check.sh: only root can install into a fresh system: use sudo" >&2
    exit 1
}
system=$(mktemp -d)
trap 'rm -rf --one-file-system "$system"' EXIT

# From where this machine has its packages.
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(apt-get indextargets --format '$(SITE) $(RELEASE)' "Codename: $suite" | sed -n "s/ $suite\$//p" | head -n 1)
debootstrap --variant=minbase "$suite" "$system" "$mirror" >"$packages/debootstrap.log"
chmod 755 "$system" # for apt's own user
rm -f "$system/etc/apt/sources.list"
cp -r /etc/apt/sources.list* /etc/apt/apt.conf.d "$system/etc/apt/"
echo 'Dpkg::Use-Pty "0";' >"$system/etc/apt/apt.conf.d/99no-terminal"
cp -L /etc/resolv.conf "$system/etc/"
mkdir "$system/packages"
cp "$packages"/*.deb "$root/tests/package/inside.sh" "$root/cmake/packaging/Containerfile" "$system/packages/"

# All that is started in there ends with it.
unshare --mount --pid --fork --mount-proc="$system/proc" chroot "$system" bash /packages/inside.sh
cp "$system/packages/view.xwd" "$packages/"
desktop-file-validate "$system"/usr/share/applications/framelet{,-viewer}.desktop

for program in framelet framelet-server framelet-viewer framelet-client; do
    exit_code=0
    said=$(qemu-x86_64 -L "$system" -cpu Nehalem "$system/usr/bin/$program" --version 2>&1) || exit_code=$?
    if [ "$exit_code" -ne 1 ] || [[ "$said" != "$program: this processor lacks"* ]]; then
        echo "check.sh: on an old processor $program ends with $exit_code: $said" >&2
        exit 1
    fi
done

DEBIAN_FRONTEND=noninteractive chroot "$system" apt-get purge -y -qq \
    framelet framelet-server framelet-viewer framelet-scenes >/dev/null
left=$(find "$system/usr" "$system/etc" -name '*framelet*')
if [ -n "$left" ]; then
    echo "check.sh: left behind when removed: $left" >&2
    exit 1
fi
echo "packages are fine"
