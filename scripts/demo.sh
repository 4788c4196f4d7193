#!/usr/bin/env bash
# From a clean clone to a picture of a cloud: installs what is missing, builds, renders, says where the picture lies.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/build.sh lumulus

picture=build/cumulus.png
echo "== Rendering configs/scenes/cumulus.toml"
build/release/lumulus render configs/scenes/cumulus.toml -o "$picture"
echo "== The picture: $PWD/$picture"
