#!/usr/bin/env bash
# Fuzzes a parser with libFuzzer (Debian packages clang and xz-utils), under AddressSanitizer and
# UndefinedBehaviorSanitizer: scripts/fuzz.sh TARGET [SECONDS, default 600] [FOLDER of more inputs to begin with].
# Targets: chunks (uploads of the frame service), exr (pictures for compare and composite), gltf (meshes), scene (scene files),
# session (connections of the frame service), vdb (OpenVDB files). The inputs that reach different code become
# tests/fuzz/corpus/TARGET.tar.xz, which the test TARGET_corpus_test replays.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

target=${1:-} seconds=${2:-600} more=${3:-}
longest=4096 headers=()
case $target in
chunks)
    sources=(service/protocol/{cloud_edit_fields,density_fields,frame_fields,json_fields,media_fields,message,query_fields,requests}.cpp
             service/render/upload_store.cpp service/values/sha256.cpp)
    libraries=(-lcrypto) longest=384
    ;;
exr)
    sources=(src/base/{atomic_file,exr,exr_claims}.cpp)
    # shellcheck disable=SC2207
    headers=($(pkg-config --cflags OpenEXR))
    # shellcheck disable=SC2207
    libraries=($(pkg-config --libs OpenEXR) -lOpenEXRCore)
    ;;
gltf)
    sources=(src/mesh/{accessor,gltf,gltf_file,gltf_material,picture}.cpp)
    libraries=(-ltinygltf -lpng -ljpeg)
    ;;
scene)
    sources=(src/scene/*.cpp
             src/base/{display_transform_none,exposure,file_kind,number_table,progress,tone_curves,tonemap}.cpp)
    libraries=(-ltbb)
    ;;
session)
    sources=(service/protocol/{cloud_edit_fields,density_fields,error_reply,frame_fields,json_fields,media_fields,message,query_fields}.cpp
             service/protocol/{requests,session}.cpp service/values/sha256.cpp)
    libraries=(-lcrypto)
    ;;
vdb)
    sources=(vdb/*.cpp src/base/{atomic_file,file_kind,progress,threads}.cpp tests/unit/vdb_throwing_new.cpp)
    headers=(-I/usr/include/Imath) libraries=(-lopenvdb -ltbb -lblosc -lz -lImath) longest=65536
    ;;
*)
    echo "usage: scripts/fuzz.sh chunks|exr|gltf|scene|session|vdb [SECONDS] [FOLDER]" >&2
    exit 2
    ;;
esac

build=$PWD/build/fuzz/$target archive=tests/fuzz/corpus/$target.tar.xz
rm -rf "$build"
mkdir -p "$build"/{corpus,found,merged}
[[ ! -f $archive ]] || tar -xf "$archive" -C "$build/corpus"
[[ -z $more ]] || cp "$more"/* "$build/found"

echo "== Building build/fuzz/$target/fuzz"
flags=(-std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined -DGLM_ENABLE_EXPERIMENTAL
       -DLUMULUS_FUZZ_INPUT="\"fuzz/${target}_input.h\"" -I. -Isrc -Ishaders -Itests "${headers[@]}")
compiler=(clang++)
[[ ! -x $(command -v ccache) ]] || compiler=(ccache clang++)
sources+=(src/base/{interrupt,text}.cpp tests/fuzz/fuzz_main.cpp)
printf "$build/objects/%s\n" "${sources[@]}" | xargs dirname | xargs mkdir -p
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -I{} "${compiler[@]}" "${flags[@]}" -c {} -o "$build/objects/{}.o"
(cd "$build/objects" && clang++ "${flags[@]}" "${sources[@]/%/.o}" "${libraries[@]}" -lfmt -o "$build/fuzz")

echo "== Fuzzing $target for $seconds s"
[[ ! -w /dev/shm ]] || export TMPDIR=/dev/shm # inputs become files: where no disk is
export LSAN_OPTIONS=suppressions=$PWD/tests/leaks.txt # leaks inside OpenVDB
options=(-max_len="$longest" -timeout=10 -artifact_prefix="$build/")
# what OpenVDB loses of old files and of grids of other types (tests/leaks.txt) is no single input's memory
[[ $target != vdb ]] || options+=(-rss_limit_mb=4096 -malloc_limit_mb=2048)
"$build/fuzz" "${options[@]}" -max_total_time="$seconds" -print_final_stats=1 "$build/found" "$build/corpus"
"$build/fuzz" "${options[@]}" -merge=1 "$build/merged" "$build/corpus" "$build/found"
tar --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -C "$build/merged" -cJf "$archive" .
echo "== $(find "$build/merged" -type f | wc -l) inputs in $archive ($(stat -c %s "$archive") bytes)"
