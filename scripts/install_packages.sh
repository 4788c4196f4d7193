#!/usr/bin/env bash
# Installs the Debian 12 packages with which Lumulus is built, run and tested, as far as they are missing.
# Needs root or sudo only where something is missing.
set -euo pipefail

packages=(
    # tools
    g++ cmake ninja-build ccache clang-format glslang-tools pkg-config dpkg-dev file python3 python3-numpy python3-openimageio python3-pil
    # the Python module and its tests
    pybind11-dev python3-dev python3-openvdb
    # clouds and pictures; nearest collectors
    libopenvdb-dev libnanovdb-dev libboost-iostreams-dev libtbb-dev libopenexr-dev libpng-dev libjpeg62-turbo-dev
    libopencolorio-dev libflann-dev
    # meshes; the reference alone traces rays by Embree
    libtinygltf-dev libembree-dev
    # plots
    libcairo2-dev fonts-dejavu-core
    # Vulkan: headers, loader, a driver that runs on the CPU, validation
    libvulkan-dev libvulkan-volk-dev libspirv-cross-c-shared-dev mesa-vulkan-drivers vulkan-validationlayers
    # the frame service and its tests: a browser, proxies, another language, an auditor
    libboost-dev libssl-dev prometheus-cpp-dev libsystemd-dev chromium chromium-driver
    python3-selenium nginx-light libnginx-mod-stream haproxy nodejs node-ws systemd openssl
    # the rest
    libcli11-dev libfmt-dev libglm-dev libtomlplusplus-dev nlohmann-json3-dev libgmock-dev libgtest-dev
)

fail() {
    echo "install_packages: $1" >&2
    exit 1
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "this is no Debian; install what these packages of Debian 12 hold: ${packages[*]}"
fi

installed=$(dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
    grep -qxF "$package installed" <<<"$installed" || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    echo "== Packages: all ${#packages[@]} are installed"
    exit 0
fi

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || fail "not root and no sudo; as root, run: apt-get install ${missing[*]}"
    as_root=(sudo)
fi
as_root+=(env DEBIAN_FRONTEND=noninteractive)
apt=(apt-get -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 -o Acquire::Retries=3)

echo "== Packages: installing ${missing[*]} (up to 200 packages with what they need; a minute or two)"
"${as_root[@]}" "${apt[@]}" update </dev/null || echo "== Packages: no fresh lists; going on with those that are here"
"${as_root[@]}" "${apt[@]}" install -y --no-install-recommends "${missing[@]}" </dev/null
