#!/usr/bin/env bash
# Installs the Debian package in a fresh Debian 12 without compilers and renders the demo scene there:
# scripts/test_package.sh [PACKAGE.deb]. Without a package it makes the one of build/release. Needs root, debootstrap and a
# mirror (that of this machine); about 800 MB below TMPDIR while it runs.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    echo "test_package: $1" >&2
    exit 1
}
[[ $EUID -eq 0 ]] || fail "a chroot needs root"
command -v debootstrap >/dev/null || fail "install debootstrap"

work=$(mktemp -d)
root=$work/root
clean() {
    for place in proc dev; do
        ! mountpoint -q "$root/$place" || umount -l "$root/$place"
    done
    rm -rf --one-file-system "$work"
}
trap clean EXIT

package=${1:-}
if [[ -z $package ]]; then
    (cd build/release && cpack -G DEB -B "$work/package" >"$work/cpack.log") || fail "cpack: $(tail -3 "$work/cpack.log")"
    package=$(echo "$work"/package/*.deb)
fi

if command -v lintian >/dev/null; then
    echo "== Lintian"
    lintian --allow-root --fail-on error "$package" || fail "lintian has found errors"
fi

# The mirror that apt of this machine uses, with its settings.
mirror=$(apt-cache policy base-files | grep -oE '(https?|file|copy)://[^ ]+' | head -1)
[[ -n $mirror ]] || fail "apt of this machine knows no mirror"
echo "== A fresh Debian 12"
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" ||
    fail "debootstrap: $(tail -3 "$work/debootstrap.log")"
cp -r /etc/apt/apt.conf.d "$root/etc/apt/"
echo "deb $mirror bookworm main" >"$root/etc/apt/sources.list"
[[ ! -e /etc/resolv.conf ]] || cp -L /etc/resolv.conf "$root/etc/resolv.conf"
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"
cp "$package" "$root/tmp/lumulus.deb"

inside() {
    chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
echo "== The package"
inside apt-get -q update >"$work/apt.log"
inside apt-get -q install -y --no-install-recommends /tmp/lumulus.deb >>"$work/apt.log" 2>&1 || fail "$(tail -5 "$work/apt.log")"
for tool in cc c++ gcc g++ clang cmake glslangValidator; do
    ! inside which "$tool" >/dev/null || fail "there is a $tool in the chroot: it shows nothing"
done

echo "== The demo scene"
inside lumulus render /usr/share/lumulus/scenes/cumulus.toml --quality draft --set image.width=320 --set image.height=180 \
    -o /tmp/cumulus.png -o /tmp/cumulus.exr --quiet
inside /usr/bin/python3 -c '
import lumulus
scene = lumulus.Scene("/usr/share/lumulus/scenes/cumulus.toml", quality="draft")
scene.update({"image.width": 320, "image.height": 180})
picture, written = lumulus.render(scene), lumulus.Picture.read("/tmp/cumulus.exr")
assert all((picture[name] == written[name]).all() for name in picture)
print("cloud covers", round(float(picture["cloud.A"].mean()), 3), "of the picture; Python has its bits")'
inside lumulus info --devices
[[ -s $root/usr/share/man/man1/lumulus.1.gz && -s $root/lib/systemd/system/lumulus.service ]] || fail "files are missing"
inside dpkg --purge lumulus >>"$work/apt.log" 2>&1 || fail "$(tail -5 "$work/apt.log")"
[[ ! -e $root/usr/bin/lumulus && ! -e $root/etc/lumulus ]] || fail "purging leaves files"
echo "== The package installs, renders and goes"
