#!/usr/bin/env bash
# In a fresh system, by check.sh: installs the packages, and does with them what a user would.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/root
programs=(framelet framelet-server framelet-viewer framelet-client)
scene=/usr/share/framelet/scenes/windmill.glb
fail() {
    echo "inside.sh: $*" >&2
    exit 1
}
runs() {
    grep -qsx "$1" /proc/[0-9]*/comm
}

apt-get update -qq
apt-get install -y -qq --no-install-recommends /packages/*.deb >/dev/null
for program in "${programs[@]}"; do # with what they depend on alone
    "$program" --version | grep -qx "$program [0-9.]*" || fail "$program --version"
done
framelet-server --info "$scene" >/dev/null
! said=$(framelet view "$scene" 2>&1) || fail "framelet view needs no display"
[[ "$said" == *"there is no display"* ]] || fail "without a display framelet view says '$said'"

# What the image of cmake/packaging/Containerfile would run, as the user that it says.
user=$(sed -n 's/^USER //p' /packages/Containerfile)
read -ra entry <<<"$(sed -n 's/^ENTRYPOINT \[\(.*\)\]$/\1/p' /packages/Containerfile | tr -d '",')"
setpriv --reuid "${user%:*}" --regid "${user#*:}" --clear-groups env -i PATH="$PATH" \
    "${entry[@]}" "$scene" --insecure --paused >/tmp/served.log 2>&1 &
server=$!
until grep -q "listening on 0.0.0.0:7070" /tmp/served.log; do
    kill -0 "$server" || fail "the image's server has ended: $(cat /tmp/served.log)"
    sleep 0.1
done
framelet-client 127.0.0.1 --size 320x180 --until-converged >/dev/null || fail "the image's server shows nothing"
exec 3<>/dev/tcp/127.0.0.1/7070
printf 'GET / HTTP/1.0\r\nHost: localhost\r\n\r\n' >&3
grep -q '<title>framelet' <&3 || fail "the image's server has no page for browsers"
exec 3<&-
kill "$server"
wait "$server" || fail "the image's server ended with $?: $(cat /tmp/served.log)"

apt-get install -y -qq --no-install-recommends xvfb man-db mandoc bash-completion >/dev/null
for program in "${programs[@]}"; do
    page=/usr/share/man/man1/$program.1.gz
    warnings=$(man --warnings -E UTF-8 -l "$page" 2>&1 >/dev/null)
    [ -z "$warnings" ] || fail "$page: $warnings"
    lexgrog "$page" | grep -q "\"$program - " || fail "$page has no name"
    mandoc -Tlint -Werror "$page" || fail "$page is no manual page"
    for section in NAME SYNOPSIS DESCRIPTION OPTIONS "EXIT STATUS" "SEE ALSO"; do
        man -l "$page" | grep -qx "$section" || fail "$page has no $section"
    done
    [ -s "/usr/share/doc/${program/client/viewer}/copyright" ] || fail "$program has no licence"
done
completed=$(bash -c 'source /usr/share/bash-completion/bash_completion
    _completion_loader framelet-server
    COMP_WORDS=(framelet-server --tls) COMP_CWORD=1 COMP_LINE="framelet-server --tls" COMP_POINT=21
    _framelet_server
    echo "${COMPREPLY[@]}"')
[ "$completed" = "--tls-cert --tls-key" ] || fail "bash completes --tls to '$completed'"

mkdir /tmp/screen
Xvfb -displayfd 3 -screen 0 1280x720x24 -fbdir /tmp/screen 3>/tmp/display >/dev/null 2>&1 &
until [ -s /tmp/display ]; do
    kill -0 $! || fail "Xvfb does not start"
    sleep 0.1
done
DISPLAY=:$(cat /tmp/display)
export DISPLAY
: >/tmp/view.log
framelet view "$scene" >/tmp/view.log 2>&1 &
view=$!
until grep -q "viewer 1 connects" /tmp/view.log; do
    kill -0 "$view" || fail "framelet view has ended: $(cat /tmp/view.log)"
    sleep 0.1
done
sleep 8
runs framelet-viewer || fail "the window has gone: $(cat /tmp/view.log)"
cp /tmp/screen/Xvfb_screen0 /packages/view.xwd
kill "$view"
wait "$view" || fail "framelet view ended with $?: $(cat /tmp/view.log)"
! runs framelet-server || fail "the server was left behind"
colors=$(tail -c +4097 /packages/view.xwd | od -An -v -tx4 -w4 | sort -u | wc -l)
[ "$colors" -gt 1000 ] || fail "the window shows $colors colours"
