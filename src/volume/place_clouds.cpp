#include "volume/place_clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "scene/places.h"
#include "volume/field_places.h"

namespace lumulus {
namespace {

/// Bytes of the light of an instance that is far away: 30 collectors of bands² coefficients in three channels.
double bytesEach(const scene::Scene& scene) {
    constexpr double collectors = 30.0, channels = 3.0;
    return collectors * channels * sizeof(float) * scene.photonMap.bands * scene.photonMap.bands;
}

void addInstances(std::vector<scene::Cloud>& placed, const scene::Cloud& cloud, const std::string& name,
                  const scene::Scene& scene) {
    const std::size_t room = mostInstances(scene) - std::min(mostInstances(scene), placed.size());
    const scene::Places places = scene::readPlaces(cloud.instances, room);
    if (places.count > places.rows.size())
        throw InputError(
            fmt::format("{} instances need at least {:.0f} MiB for their light, and "
                        "photon_map.memory_budget has {:.0f} MiB",
                        places.count, std::ceil(std::ldexp(bytesEach(scene) * static_cast<double>(places.count), -20)),
                        scene.photonMap.memoryBudget),
            cloud.instances.string(), "leave rows out, or raise the budget");
    for (std::size_t row = 0; row < places.rows.size(); ++row) {
        scene::Cloud instance = cloud;
        instance.instances.clear();
        instance.name = fmt::format("{}[{}]", name, row);
        instance.transform = places.rows[row].transform() * cloud.transform;
        instance.extinction *= places.rows[row].extinction;
        placed.push_back(std::move(instance));
    }
}

void addField(std::vector<scene::Cloud>& placed, const scene::Field& field, const std::string& name,
              const scene::Scene& scene, KnownPlaces& known) {
    const std::size_t room = mostInstances(scene) - std::min(mostInstances(scene), placed.size());
    const std::vector<FieldPlace>& places = known.of(field, name, room);
    for (std::size_t i = 0; i < places.size(); ++i) {
        scene::Cloud cloud;
        cloud.name = fmt::format("{}[{}]", name, i);
        cloud.procedural = proceduralKind(field.kind);
        cloud.resolution = field.resolution;
        cloud.seed = variantSeed(field, places[i].variant);
        cloud.transform = places[i].place.transform();
        cloud.transform[3] += glm::dvec4(scene.seconds * field.wind.at(places[i].middle), 0.0);
        cloud.extinction = field.extinction * places[i].place.extinction;
        cloud.albedo = field.albedo;
        cloud.phase = field.phase;
        placed.push_back(std::move(cloud));
    }
}

}  // namespace

std::size_t mostInstances(const scene::Scene& scene) {
    return static_cast<std::size_t>(std::ldexp(scene.photonMap.memoryBudget, 20) / bytesEach(scene));
}

const std::vector<FieldPlace>& KnownPlaces::of(const scene::Field& field, const std::string& name, std::size_t most) {
    std::erase_if(known_, [this](const Known& each) { return each.scene + 1 < scene_; });
    auto found =
        std::ranges::find_if(known_, [&](const Known& each) { return each.most == most && each.field == field; });
    if (found == known_.end()) {
        known_.push_back({field, most, scene_, placesOf(field, name, most)});
        found = known_.end() - 1;
    }
    found->scene = scene_;
    return found->places;
}

scene::Scene placeClouds(scene::Scene scene, KnownPlaces* known) {
    const bool single = scene.fields.empty() && std::ranges::all_of(scene.clouds, [](const scene::Cloud& cloud) {
                            return cloud.instances.empty();
                        });
    if (single) return scene;
    KnownPlaces ofThis;
    KnownPlaces& places = known != nullptr ? *known : ofThis;
    places.beginScene();
    std::vector<scene::Cloud> placed;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const std::string name = scene::nameOf(scene, i);
        if (!scene.clouds[i].instances.empty()) {
            addInstances(placed, scene.clouds[i], name, scene);
            continue;
        }
        placed.push_back(scene.clouds[i]);
        placed.back().name = name;
    }
    for (std::size_t i = 0; i < scene.fields.size(); ++i) {
        const std::string& name = scene.fields[i].name;
        addField(placed, scene.fields[i], name.empty() ? fmt::format("field{}", i) : name, scene, places);
    }
    scene.clouds = std::move(placed);
    scene.fields.clear();
    return scene;
}

}  // namespace lumulus
