#!/usr/bin/env bash
# Installs what is missing, then configures and builds the release preset: scripts/build.sh [TARGET…], default all.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_packages.sh

# A cache that another folder left (a copied or moved clone) would be refused.
cache=build/release/CMakeCache.txt
fresh=()
if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$cache"; then
    fresh=(--fresh)
fi

echo "== Configuring build/release"
cmake "${fresh[@]}" --preset release --log-level=NOTICE

echo "== Building ${*:-everything} (the first time takes minutes)"
targets=()
[[ $# -eq 0 ]] || targets=(--target "$@")
cmake --build --preset release --parallel "$(nproc)" "${targets[@]}"
