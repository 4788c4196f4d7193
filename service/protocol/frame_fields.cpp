#include "service/protocol/frame_fields.h"

#include <array>
#include <nlohmann/json.hpp>

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr double farthest = 1e9;   // metres, as in scene files
constexpr double brightest = 1e9;  // W/m², as in scene files
constexpr int widest = 16384;      // pixels, as in scene files
constexpr double widestTangent = 1e3;

constexpr std::array projections{scene::Projection::perspective, scene::Projection::orthographic,
                                 scene::Projection::panorama};

glm::dvec3 unitVector(JsonFields& fields, const char* name, const glm::dvec3& v) {
    const double length = glm::length(v);
    if (!(length > 1e-12))
        throw RequestError("bad_request", fields.place(name) + " must have a length", fields.place(name));
    return v / length;
}

std::optional<Tile> readTile(JsonFields& fields) {
    const auto values = fields.numbers("tile", 4, 0.0, widest);
    if (!values) return std::nullopt;
    std::array<int, 4> whole{};
    for (std::size_t i = 0; i < 4; ++i) {
        whole.at(i) = static_cast<int>((*values)[i]);
        if (static_cast<double>(whole.at(i)) != (*values)[i])
            throw RequestError("bad_request", fields.place("tile") + " must be whole numbers", fields.place("tile"));
    }
    return Tile{whole[0], whole[1], whole[2], whole[3]};
}

ViewRequest readView(JsonFields& fields) {
    ViewRequest view;
    if (const json* camera = fields.object("camera")) {
        JsonFields inner(*camera, fields.place("camera"));
        view.camera = readCamera(inner);
        inner.finish();
    }
    const auto size = [&](const char* name) {
        const auto value = fields.integer(name, 1, widest);
        return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
    };
    view.width = size("width");
    view.height = size("height");
    view.tile = readTile(fields);
    return view;
}

void requirePixels(const std::vector<ViewRequest>& views, const RequestLimits& limits) {
    double pixels = 0.0;
    for (const ViewRequest& view : views) {
        if (view.tile)
            pixels += static_cast<double>(view.tile->width) * view.tile->height;
        else if (view.width && view.height)
            pixels += static_cast<double>(*view.width) * *view.height;
    }
    if (pixels > static_cast<double>(limits.pixels))
        throw RequestError("too_large", "a frame may hold " + std::to_string(limits.pixels) + " pixels here", "width");
}

std::vector<ViewRequest> readViews(JsonFields& fields, const RequestLimits& limits) {
    std::vector<ViewRequest> views{readView(fields)};
    if (const json* list = fields.array("views", limits.views)) {
        const ViewRequest& alone = views.front();
        if (alone.width || alone.height || alone.tile || fields.object("camera") != nullptr)
            throw RequestError("bad_request", "camera, width, height and tile belong into the views", "views");
        if (list->empty()) throw RequestError("bad_request", "views is empty", "views");
        views.clear();
        for (std::size_t i = 0; i < list->size(); ++i) {
            JsonFields inner((*list)[i], fields.place("views") + "[" + std::to_string(i) + "]");
            views.push_back(readView(inner));
            inner.finish();
        }
    }
    requirePixels(views, limits);
    return views;
}

Budget readBudget(JsonFields& fields) {
    Budget budget;
    if (const json* object = fields.object("budget")) {
        JsonFields inner(*object, fields.place("budget"));
        budget.milliseconds = inner.number("milliseconds", 0.0, 1e7);
        const auto photons = inner.integer("photons", 0, std::int64_t{1} << 53U);
        if (photons) budget.photons = static_cast<std::uint64_t>(*photons);
        if (budget.milliseconds && budget.photons)
            throw RequestError("bad_request", "a budget is milliseconds or photons, not both", "budget");
        inner.finish();
    }
    return budget;
}

std::vector<Product> readProducts(JsonFields& fields) {
    static constexpr std::array<std::string_view, 5> names{"color", "cloud", "transmittance", "depth", "front"};
    const auto wanted = fields.texts("products", names.size(), 20);
    if (!wanted) return {Product::color};
    std::vector<Product> products;
    for (const std::string& name : *wanted) {
        const auto* const it = std::find(names.begin(), names.end(), name);
        const auto product = static_cast<Product>(it - names.begin());
        if (it == names.end() || std::find(products.begin(), products.end(), product) != products.end())
            throw RequestError("bad_request", "products are color, cloud, transmittance, depth, front, each once",
                               fields.place("products"));
        products.push_back(product);
    }
    if (products.empty()) throw RequestError("bad_request", "products is empty", fields.place("products"));
    return products;
}

}  // namespace

CameraRequest readCamera(JsonFields& fields) {
    CameraRequest camera;
    camera.position = fields.vector("position", -farthest, farthest);
    camera.target = fields.vector("target", -farthest, farthest);
    camera.up = fields.vector("up", -farthest, farthest);
    if (camera.up) camera.up = unitVector(fields, "up", *camera.up);
    if (const auto q = fields.numbers("orientation", 4, -1.0, 1.0)) {
        camera.orientation = glm::dquat((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
        if (!(glm::length(*camera.orientation) > 0.5))
            throw RequestError("bad_request", fields.place("orientation") + " must be a unit quaternion [w, x, y, z]",
                               fields.place("orientation"));
        if (camera.target || camera.up || !camera.position)
            throw RequestError("bad_request", "an orientation goes with a position, without target and up",
                               fields.place("orientation"));
    }
    camera.verticalFov = fields.number("vertical_fov", 0.01, 170.0);
    if (const auto f = fields.numbers("frustum", 4, -widestTangent, widestTangent)) {
        camera.frustum = Frustum{(*f)[0], (*f)[1], (*f)[2], (*f)[3]};
        if (!(camera.frustum->left < camera.frustum->right) || !(camera.frustum->bottom < camera.frustum->top))
            throw RequestError("bad_request", "a frustum is [left, right, bottom, top], left < right, bottom < top",
                               fields.place("frustum"));
    }
    if (const auto choice = fields.choice("projection", {"perspective", "orthographic", "panorama"}))
        camera.projection = projections.at(*choice);
    return camera;
}

LightChange readLight(JsonFields& fields) {
    LightChange light;
    if (const json* sun = fields.object("sun")) {
        JsonFields inner(*sun, fields.place("sun"));
        const auto direction = inner.vector("direction_to", -farthest, farthest);
        const auto azimuth = inner.number("azimuth", -360.0, 360.0);
        const auto elevation = inner.number("elevation", -90.0, 90.0);
        if (direction && (azimuth || elevation))
            throw RequestError("bad_request", "give the sun's direction_to, or azimuth and elevation", "sun");
        if (direction) light.sunDirection = unitVector(inner, "direction_to", *direction);
        if (azimuth || elevation)
            light.sunDirection = scene::skyDirection(azimuth.value_or(scene::defaultAzimuth),
                                                     elevation.value_or(scene::defaultElevation));
        light.sunIrradiance = inner.vector("irradiance", 0.0, brightest);
        inner.finish();
    }
    light.extinction = fields.number("extinction", 1e-9, 1e6);
    light.wind = fields.vector("wind", -1e4, 1e4);
    return light;
}

PictureFormat readFormat(JsonFields& fields) {
    PictureFormat result;
    if (const auto choice = fields.choice("encoding", {"half", "float", "exr", "png", "jpeg"}))
        result.encoding = static_cast<Encoding>(*choice);
    result.quality = static_cast<int>(fields.integer("quality", 1, 100).value_or(result.quality));
    result.exposure = fields.number("exposure", -64.0, 64.0);
    result.hash = fields.flag("hash").value_or(true);
    return result;
}

FrameRequest readFrame(JsonFields& fields, const RequestLimits& limits) {
    FrameRequest frame;
    frame.channel = static_cast<std::uint32_t>(fields.integer("channel", 0, 65535).value_or(0));
    frame.queue = fields.flag("queue").value_or(false);
    frame.views = readViews(fields, limits);
    frame.time = fields.number("time", -1e9, 1e9).value_or(0.0);
    frame.light = readLight(fields);
    frame.budget = readBudget(fields);
    frame.products = readProducts(fields);
    frame.format = readFormat(fields);
    const Encoding encoding = frame.format.encoding;
    const bool forPeople = encoding == Encoding::png || encoding == Encoding::jpeg;
    if (forPeople && frame.products != std::vector{Product::color})
        throw RequestError("bad_request", "png and jpeg hold color alone", fields.place("products"));
    return frame;
}

}  // namespace lumulus::service
