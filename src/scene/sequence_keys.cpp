#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {

namespace {

constexpr std::array extends{Extend::hold, Extend::repeat, Extend::pingPong, Extend::clip};

FileSequence& sequenceOf(Draft& d) {
    return d.scene.clouds.at(d.entry).sequence;
}

}  // namespace

std::vector<Key> sequenceKeys() {
    return {
        other("cloud.frames", Type::pair, "(none: every frame has a file)",
              "First and last number of the files, where `vdb` has #### or %04d for it.",
              [](Draft& d, const Value& v) { sequenceOf(d).frames = glm::i64vec2(v.vector); }),
        number("cloud.fps", {0.0, 10000.0, true}, "(that of the animation)", "Files a second.",
               [](Draft& d, const Value& v) { sequenceOf(d).fps = v.number; }),
        number("cloud.offset", {-1e9, 1e9}, "0.0", "Files by which the cloud is ahead.",
               [](Draft& d, const Value& v) { sequenceOf(d).offset = v.number; }),
        number("cloud.speed", {0.0, 1000.0}, "1.0", "Factor of the speed at which files follow each other.",
               [](Draft& d, const Value& v) { sequenceOf(d).speed = v.number; }),
        choice("cloud.extend", {"hold", "repeat", "ping-pong", "clip"}, "\"hold\"",
               "What the cloud is before the first and behind the last of `frames`: that file, all again, all again to "
               "and fro, or not there.",
               [](Draft& d, const Value& v) { sequenceOf(d).extend = extends.at(v.choice); }),
        choice("cloud.between", {"motion", "nearest"}, "\"motion\"",
               "What is shown between two files: both, each carried along the motion to that time (by the grid `vel`, "
               "`velocity` or `v` of the files, else by `velocity`; without either they are blended), or the nearest "
               "one.",
               [](Draft& d, const Value& v) { sequenceOf(d).interpolate = v.choice == 0; }),
        other(
            "cloud.velocity", Type::wind, "(that of the files)",
            "Velocity of what is in the files, before `transform` [m/s], or rows of a height in the files' own "
            "coordinates and the velocity there, as for `field.wind`. Files with a grid of velocities have their own.",
            [](Draft& d, const Value& v) { d.scene.clouds.at(d.entry).velocity = v.wind; }),
        choice("cloud.missing", {"error", "hold"}, "\"error\"",
               "What a file is that is missing: an error with its number, or the one before it, with a warning.",
               [](Draft& d, const Value& v) { sequenceOf(d).holdMissing = v.choice == 1; })};
}

}  // namespace lumulus::scene
