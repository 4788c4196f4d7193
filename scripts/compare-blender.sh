#!/usr/bin/env bash
# Puts Blender's Cycles into the plot of error against time: renders the same density, camera, sun and sky with it at
# growing samples, and runs `lumulus bench` with its points. Options: scripts/compare-blender.sh --help
# Blender (Debian package `blender`, 3.4) is needed for this alone.
set -euo pipefail
scripts=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if ! command -v blender >/dev/null; then
    echo "compare-blender: there is no Blender: as root, run apt-get install --no-install-recommends blender" >&2
    exit 1
fi
exec /usr/bin/python3 "$scripts/compare_blender.py" "$@"
