#!/usr/bin/env bash
# Fuzzes the frame service's session and decoder with libFuzzer (Debian package clang), under AddressSanitizer and
# UndefinedBehaviorSanitizer: scripts/fuzz_session.sh [SECONDS, default 600]. New inputs that reach new code are merged
# into tests/fuzz/corpus/session.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-600}
build=build/fuzz
corpus=tests/fuzz/corpus/session
mkdir -p "$build/found"

flags=(-std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined -DGLM_ENABLE_EXPERIMENTAL
       -I. -Isrc -Ishaders -Itests)
sources=(service/protocol/{error_reply,frame_fields,json_fields,message,requests,session}.cpp service/values/sha256.cpp
         src/base/text.cpp tests/fuzz/session_fuzz.cpp)
clang++ "${flags[@]}" "${sources[@]}" -lfmt -lcrypto -o "$build/session_fuzz"

"$build/session_fuzz" -max_total_time="$seconds" -max_len=4096 -timeout=5 -print_final_stats=1 "$build/found" "$corpus"
"$build/session_fuzz" -merge=1 -max_len=1024 "$corpus" "$build/found"
