#include "render/pass_stage.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace lumulus {

namespace {

struct Entry {
    std::string_view pass;
    Stage stage;
};

constexpr std::array<Entry, 34> entries{{
    {"photon starts", Stage::photons},
    {"trace", Stage::photons},
    {"sort", Stage::photons},
    {"gather", Stage::photons},
    {"accumulate", Stage::photons},
    {"reconstruct", Stage::light},
    {"light counts", Stage::light},
    {"light field", Stage::light},
    {"billboard means", Stage::light},
    {"shadow volume", Stage::shadowVolume},
    {"shared shadow", Stage::shadowVolume},
    {"mesh shadow", Stage::shadowVolume},
    {"mesh rays", Stage::draw},
    {"march", Stage::draw},
    {"billboards", Stage::draw},
    {"interpolate", Stage::draw},
    {"interpolate refined", Stage::draw},
    {"atlas", Stage::light},
    {"frame background", Stage::fog},
    {"frame sky", Stage::draw},
    {"frame sky map", Stage::draw},
    {"frame sun", Stage::fog},
    {"frame band", Stage::fog},
    {"frame download", Stage::fog},
    {"lit fog", Stage::fog},
    {"fog margin", Stage::fog},
    {"fog spread", Stage::fog},
    {"fog split", Stage::fog},
    {"fog join", Stage::fog},
    {"fog light", Stage::fog},
    {"fog down", Stage::fog},
    {"fog up", Stage::fog},
    {"fog fetch", Stage::fog},
    {"fog exact", Stage::fog},
}};

}  // namespace

Stage stageOf(std::string_view pass) {
    const auto* const entry = std::ranges::find(entries, pass, &Entry::pass);
    if (entry == entries.end()) throw std::logic_error("the pass \"" + std::string(pass) + "\" has no stage");
    return entry->stage;
}

}  // namespace lumulus
