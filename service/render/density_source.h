#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "service/render/render_config.h"
#include "service/render/scene_source.h"
#include "service/values/requests.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Another density for clouds of a scene that a client sees.
struct DensityWish {
    SourcedScene shown;  ///< the scene, as it was loaded or edited
    NewDensity density;
    std::vector<std::size_t> clouds;  ///< that get it; none: all that show files of a sequence
};

/// DensityWish::clouds of a change: the one that is named, else the only one where it is for an upload. Errors:
/// RequestError `not_found`, `bad_request`.
std::vector<std::size_t> cloudsOfDensity(const scene::Scene& scene, const NewDensity& density,
                                         const std::optional<CloudReference>& cloud);

/// The scene with another density, under a key of its own. Errors: RequestError `not_found` for an upload that is not
/// here, `bad_request` for a frame that the scene's file does not have, or for a cloud that is no sequence there.
SourcedScene sourceDensity(const DensityWish& wish, const RenderConfig& config, ClientId owner, std::uint64_t id);

/// What the clouds that have got it show.
std::vector<CloudShown> cloudsShown(const scene::Scene& scene, const DensityWish& wish);

}  // namespace lumulus::service
