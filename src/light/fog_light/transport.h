#pragma once

#include <optional>

#include "light/fog_light/krylov.h"
#include "light/fog_light/stack.h"

namespace lumulus::fog_light {

constexpr int streamCount = momentCount / 2;  ///< of a hemisphere: a Gauss rule of the cosine

/// Cosines of the streams to the vertical, and their weights, which add up to 1.
struct Streams {
    Vector cosines, weights;
};
const Streams makeStreams();

/// Parallel light from above.
struct Beam {
    double irradiance = 0.0;  ///< across it, above all layers [W/m²]
    double cosine = 1.0;      ///< to the vertical
};

/// Light that comes in at the highest and at the lowest level, by stream [W/(m² sr)]; of one azimuthal mode.
struct Incoming {
    Vector above, below;
};

/// Radiance at all levels in one azimuthal mode: [level][stream].
struct Radiance {
    Vector up, down;
};

/// Light that goes through a stack in one mode cos mφ of the azimuth, by discrete ordinates (Chandrasekhar 1950).
/// Between levels, sources are linear in the optical depth and the beam's are exponential; both are integrated exactly.
class ModeTransport {
  public:
    /// `albedo` of a ground at the lowest level; none: light leaves there.
    ModeTransport(const Stack& stack, int mode, std::optional<double> albedo);

    /// Legendre moments [level][degree] of all light but the beam: of any order of scattering.
    Vector solve(const Beam& beam, const Incoming& incoming) const;
    /// Radiance that light of these moments makes when it is scattered once more, with what comes in.
    Radiance radiance(const Vector& moments, const Beam& beam, const Incoming& incoming) const;
    /// Irradiance of a plane that faces upwards at the lowest level, without the beam [W/m²]; of the mode 0.
    double irradianceBelow(const Radiance& radiance) const;

  private:
    Radiance sweep(const Vector& sources, const Vector& beamSources, const Beam& beam, const Incoming& incoming) const;
    Vector sourcesOf(const Vector& moments) const;
    Vector beamSources(const Beam& beam) const;
    Vector momentsOf(const Radiance& radiance) const;
    void addSource(std::size_t interval, const double* moments, double* up, double* down) const;

    const Stack& stack_;
    int mode_;
    std::optional<double> albedo_;
    Streams streams_;
    std::vector<Vector> legendre_;      ///< [degree][stream]
    Vector passes_, nearer_, farther_;  ///< [interval][stream]: of the light that comes in, of the source at either end
};

/// ∫ of a source linear in the optical depth against its attenuation over `depth`: weights of its values where light
/// comes in and where it leaves.
struct SourceWeights {
    double passes, first, last;
};
SourceWeights sourceWeights(double depth);

/// The same of a beam's source, against its value at the upper end of an interval of vertical depth `depth`: of light
/// that leaves upwards and downwards. Cosines of beam and light to the vertical.
double beamWeightUp(double depth, double beam, double light);
double beamWeightDown(double depth, double beam, double light);

}  // namespace lumulus::fog_light
