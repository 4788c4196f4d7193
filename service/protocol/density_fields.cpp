#include "service/protocol/density_fields.h"

#include "service/protocol/requests.h"

namespace lumulus::service {

std::optional<NewDensity> readDensity(JsonFields& fields) {
    constexpr std::size_t longestName = 200;
    constexpr double mostFrames = 1e9, longest = 1e6;  // seconds
    const auto vdb = fields.text("vdb", longestName);
    const auto grid = fields.text("grid", longestName);
    const auto frame = fields.number("frame", -mostFrames, mostFrames);
    const auto seconds = fields.number("seconds", 0.0, longest);
    if (!vdb && !frame) {
        if (grid || seconds)
            throw RequestError("bad_request", "give the density that is meant: vdb (an upload) or frame",
                               fields.place(grid ? "grid" : "seconds"));
        return std::nullopt;
    }
    if (vdb && frame)
        throw RequestError("bad_request", "give an upload or a frame of the scene, not both", fields.place("frame"));
    if (seconds && frame)
        throw RequestError("bad_request", "a sequence says itself how its frames follow each other",
                           fields.place("seconds"));
    NewDensity density;
    if (vdb) density.vdb = requireHash(*vdb, "vdb");
    density.grid = grid.value_or("");
    density.frame = frame;
    density.seconds = seconds.value_or(0.0);
    return density;
}

}  // namespace lumulus::service
