#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct _cairo;
struct _cairo_surface;

namespace lumulus::bench {

struct Point {
    double x = 0.0, y = 0.0;
};

/// An sRGB colour, each channel 0…1.
struct Colour {
    double red = 0.0, green = 0.0, blue = 0.0;
};

struct Stroke {
    Colour colour;
    double width = 1.0;
    std::vector<double> dashes;  ///< alternating lengths of dashes and gaps; empty: a solid line
};

enum class Anchor { left, middle, right };

/// A white sheet for lines and words, in pixels from the upper left corner, drawn by Cairo and finished as the bytes of
/// a file.
class Canvas {
  public:
    static Canvas svg(double width, double height);
    /// A canvas for a PNG file with `scale` texels a pixel.
    static Canvas png(double width, double height, double scale);

    void line(std::span<const Point> points, const Stroke& stroke);
    void box(const Point& upperLeft, const Point& lowerRight, const Stroke& stroke);
    /// Draws a disc: filled with its colour, or white with an outline of the colour.
    void disc(const Point& centre, double radius, const Colour& colour, bool filled);
    /// Writes words on the baseline through `at`. Bytes that are no UTF-8 appear as question marks.
    void text(const Point& at, Anchor anchor, const std::string& words);
    /// Writes words that run upwards.
    void textUpwards(const Point& at, Anchor anchor, const std::string& words);

    /// Finishes the file and returns its bytes. Nothing can be drawn afterwards. Errors: Error if Cairo could not draw.
    std::vector<std::byte> finish();

  private:
    struct Release {
        void operator()(_cairo* context) const;
        void operator()(_cairo_surface* surface) const;
    };
    using Bytes = std::vector<std::byte>;

    Canvas(std::unique_ptr<Bytes> bytes, _cairo_surface* surface, bool raster);
    void begin(const Stroke& stroke);

    std::unique_ptr<Bytes> bytes_;  ///< Cairo writes to this place, so it must not move
    bool raster_;
    std::unique_ptr<_cairo_surface, Release> surface_;
    std::unique_ptr<_cairo, Release> context_;
};

}  // namespace lumulus::bench
