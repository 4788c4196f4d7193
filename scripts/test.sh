#!/usr/bin/env bash
# From a clean clone to the result of all tests: installs what is missing, builds everything, runs CTest.
# Arguments go to CTest: scripts/test.sh -R vdb
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/build.sh

echo "== Testing"
exec ctest --preset release -j2 --output-on-failure --timeout 300 "$@"
