#!/usr/bin/env bash
# Runs the table of stiff and extreme cases and writes docs/stability.md. Options: scripts/stability.sh --help
set -euo pipefail
exec /usr/bin/python3 "$(dirname "${BASH_SOURCE[0]}")/stability.py" "$@"
