#include "bench/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"

namespace lumulus::bench {
namespace {

constexpr double fontSize = 12.0;

void setFont(cairo_t* context) {
    cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, fontSize);
}

void setColour(cairo_t* context, const Colour& colour) {
    cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
}

void require(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) {
        throw Error(std::string("cannot draw the plot: ") + cairo_status_to_string(status), "Cairo",
                    "free some memory, or look whether fonts are installed");
    }
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
    const std::span<const std::byte> more = std::as_bytes(std::span(data, length));
    auto& all = *static_cast<std::vector<std::byte>*>(bytes);
    all.insert(all.end(), more.begin(), more.end());
    return CAIRO_STATUS_SUCCESS;
}

/// Text that Cairo can show. File names may hold any bytes, and an error would end the drawing.
std::string showable(std::string words) {
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
    cairo_t* context = cairo_create(surface);
    setFont(context);
    cairo_text_extents_t extents;
    cairo_text_extents(context, words.c_str(), &extents);
    const bool fails = cairo_status(context) == CAIRO_STATUS_INVALID_STRING;
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    if (fails)
        std::ranges::replace_if(
            words, [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
    return words;
}

}  // namespace

void Canvas::Release::operator()(_cairo* context) const {
    cairo_destroy(context);
}

void Canvas::Release::operator()(_cairo_surface* surface) const {
    cairo_surface_destroy(surface);
}

Canvas::Canvas(std::unique_ptr<Bytes> bytes, _cairo_surface* surface, bool raster)
    : bytes_(std::move(bytes)), raster_(raster), surface_(surface), context_(cairo_create(surface)) {
    setColour(context_.get(), {1.0, 1.0, 1.0});
    cairo_paint(context_.get());
    setFont(context_.get());
}

Canvas Canvas::svg(double width, double height) {
    auto bytes = std::make_unique<Bytes>();
    cairo_surface_t* surface = cairo_svg_surface_create_for_stream(append, bytes.get(), width, height);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    return {std::move(bytes), surface, false};
}

Canvas Canvas::png(double width, double height, double scale) {
    const auto texels = [scale](double length) { return static_cast<int>(std::lround(scale * length)); };
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, texels(width), texels(height));
    cairo_surface_set_device_scale(surface, scale, scale);
    return {std::make_unique<Bytes>(), surface, true};
}

void Canvas::begin(const Stroke& stroke) {
    setColour(context_.get(), stroke.colour);
    cairo_set_line_width(context_.get(), stroke.width);
    cairo_set_dash(context_.get(), stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0.0);
}

void Canvas::line(std::span<const Point> points, const Stroke& stroke) {
    begin(stroke);
    for (const Point& point : points) cairo_line_to(context_.get(), point.x, point.y);
    cairo_stroke(context_.get());
}

void Canvas::box(const Point& upperLeft, const Point& lowerRight, const Stroke& stroke) {
    begin(stroke);
    cairo_rectangle(context_.get(), upperLeft.x, upperLeft.y, lowerRight.x - upperLeft.x, lowerRight.y - upperLeft.y);
    cairo_stroke(context_.get());
}

void Canvas::disc(const Point& centre, double radius, const Colour& colour, bool filled) {
    begin({colour, 1.5, {}});
    cairo_arc(context_.get(), centre.x, centre.y, radius, 0.0, 2.0 * std::numbers::pi);
    if (!filled) setColour(context_.get(), {1.0, 1.0, 1.0});
    cairo_fill_preserve(context_.get());
    setColour(context_.get(), colour);
    cairo_stroke(context_.get());
}

void Canvas::text(const Point& at, Anchor anchor, const std::string& words) {
    const std::string shown = showable(words);
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), shown.c_str(), &extents);
    const double share = anchor == Anchor::left ? 0.0 : anchor == Anchor::middle ? 0.5 : 1.0;
    setColour(context_.get(), {0.1, 0.1, 0.1});
    cairo_move_to(context_.get(), at.x - share * extents.x_advance, at.y);
    cairo_show_text(context_.get(), shown.c_str());
    cairo_new_path(context_.get());  // otherwise the next line would begin behind the words
}

void Canvas::textUpwards(const Point& at, Anchor anchor, const std::string& words) {
    cairo_save(context_.get());
    cairo_translate(context_.get(), at.x, at.y);
    cairo_rotate(context_.get(), -0.5 * std::numbers::pi);
    text({0.0, 0.0}, anchor, words);
    cairo_restore(context_.get());
}

std::vector<std::byte> Canvas::finish() {
    require(cairo_status(context_.get()));
    context_.reset();
    if (raster_) require(cairo_surface_write_to_png_stream(surface_.get(), append, bytes_.get()));
    cairo_surface_finish(surface_.get());
    require(cairo_surface_status(surface_.get()));
    return std::move(*bytes_);
}

}  // namespace lumulus::bench
