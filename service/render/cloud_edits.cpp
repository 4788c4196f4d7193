#include "service/render/cloud_edits.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::size_t mostClouds = 256;

bool readsG(const scene::Phase& phase) {
    return phase.model == scene::PhaseModel::henyeyGreenstein || phase.model == scene::PhaseModel::schlick;
}

/// Makes the edits in a scene.
class Editor {
  public:
    explicit Editor(const scene::Scene& before) {
        edited_.scene = before;
        for (std::size_t i = 0; i < before.clouds.size(); ++i) {
            edited_.scene.clouds[i].name = scene::nameOf(before, i);
            edited_.origins.push_back({i});
            edited_.moves.emplace_back();
        }
    }

    void apply(const CloudEdit& edit, const std::string& place) {
        switch (edit.kind) {
            case CloudEdit::Kind::add:
                add(edit, place);
                break;
            case CloudEdit::Kind::remove:
                remove(findCloud(edited_.scene, edit.cloud, place + ".remove"));
                break;
            case CloudEdit::Kind::alter:
                const std::size_t cloud = findCloud(edited_.scene, edit.cloud, place + ".cloud");
                alter(edit, cloud, place);
                // one that was added in the same request has its place already
                if (edit.move && edited_.origins[cloud].added) edited_.origins[cloud].move = *edit.move;
                if (edit.move && !edited_.origins[cloud].added) edited_.moves[cloud] = edit.move;
                break;
        }
    }

    EditedClouds take() { return std::move(edited_); }

  private:
    void add(const CloudEdit& edit, const std::string& place) {
        std::vector<scene::Cloud>& clouds = edited_.scene.clouds;
        const std::size_t like = findCloud(edited_.scene, edit.cloud, place + ".like");
        if (std::ranges::any_of(clouds, [&](const scene::Cloud& cloud) { return cloud.name == edit.name; }))
            throw RequestError("bad_request", "the scene has a cloud \"" + edit.name + "\" already", place + ".add");
        if (clouds.size() >= mostClouds)
            throw RequestError("too_large", "a scene may have " + std::to_string(mostClouds) + " clouds",
                               place + ".add");
        scene::Cloud added = clouds[like];
        added.name = edit.name;
        clouds.push_back(std::move(added));
        CloudOrigin origin = edited_.origins[like];
        origin.added = true;
        origin.yaw += edit.yaw * std::numbers::pi / 180.0;
        origin.scale *= edit.scale;
        origin.move += edit.move.value_or(glm::dvec3(0.0));
        edited_.origins.push_back(origin);
        edited_.moves.emplace_back();
        edited_.rebuilds = true;
        alter(edit, clouds.size() - 1, place);
    }

    void remove(std::size_t cloud) {
        const auto at = static_cast<std::ptrdiff_t>(cloud);
        edited_.scene.clouds.erase(edited_.scene.clouds.begin() + at);
        edited_.origins.erase(edited_.origins.begin() + at);
        edited_.moves.erase(edited_.moves.begin() + at);
        edited_.rebuilds = true;
    }

    /// All but its place.
    void alter(const CloudEdit& edit, std::size_t number, const std::string& place) {
        scene::Cloud& cloud = edited_.scene.clouds[number];
        const scene::Cloud before = cloud;
        cloud.extinction = edit.extinction.value_or(cloud.extinction);
        cloud.albedo = edit.albedo.value_or(cloud.albedo);
        if (edit.asymmetry && !readsG(cloud.phase))
            throw RequestError("bad_request", "the phase function of cloud \"" + cloud.name + "\" has no g",
                               place + ".g");
        cloud.phase.g = edit.asymmetry.value_or(cloud.phase.g);
        if (cloud.albedo == before.albedo && cloud.phase == before.phase) return;
        edited_.origins[number].substance = true;
        edited_.rebuilds = true;
    }

    EditedClouds edited_;
};

}  // namespace

std::size_t findCloud(const scene::Scene& scene, const CloudReference& cloud, const std::string& where) {
    const auto* const index = std::get_if<std::uint32_t>(&cloud);
    if (index != nullptr && *index < scene.clouds.size()) return *index;
    for (std::size_t i = 0; index == nullptr && i < scene.clouds.size(); ++i)
        if (scene::nameOf(scene, i) == std::get<std::string>(cloud)) return i;
    const std::string wanted = index != nullptr ? std::to_string(*index) : "\"" + std::get<std::string>(cloud) + "\"";
    throw RequestError("not_found", "the scene has no cloud " + wanted, where);
}

EditedClouds editClouds(const scene::Scene& before, std::span<const CloudEdit> edits) {
    Editor editor(before);
    for (std::size_t i = 0; i < edits.size(); ++i) editor.apply(edits[i], "clouds[" + std::to_string(i) + "]");
    return editor.take();
}

void placeAdded(scene::Scene& scene, const Renderer& renderer, std::span<const CloudOrigin> origins,
                const scene::Scene& before, const Renderer& rendererBefore) {
    for (std::size_t i = 0; i < origins.size(); ++i) {
        if (!origins[i].added) continue;
        const std::size_t from = origins[i].from;
        scene.clouds[i].transform =
            renderer.placementOf(i) * glm::inverse(rendererBefore.placementOf(from)) * before.clouds[from].transform;
    }
}

}  // namespace lumulus::service
