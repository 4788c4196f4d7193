#include <cmath>

#include "vdb/noise.h"
#include "vdb/procedural_kinds.h"

// A deck of stratocumulus: closed convection cells, a wavy top, a ragged flat base, gaps and a torn rim.
namespace lumulus::vdb {
namespace {

constexpr float kWidth = 2000.0F;
constexpr float kHeight = 200.0F;

struct Column {
    float base = 0.0F;  ///< metres
    float top = 0.0F;   ///< metres; not above the base where the deck has a gap
};

class Stratus {
  public:
    explicit Stratus(std::uint64_t seed)
        : cells_(deriveSeed(seed, 1)),
          cover_(deriveSeed(seed, 2)),
          waves_(deriveSeed(seed, 3)),
          fine_(deriveSeed(seed, 4)) {}

    Column column(float x, float z) const {
        const glm::vec3 p(x, 0.0F, z);
        const glm::vec3 bend(fractalNoise(p / 260.0F, waves_, 5), 0.0F, fractalNoise(p / 260.0F, waves_ + 8U, 5));
        const glm::vec3 bent = p + 190.0F * bend;
        const float cell = 0.65F * billowNoise(bent / 310.0F, cells_) + 0.35F * billowNoise(bent / 120.0F, cells_ + 1U);
        const float cover = fractalNoise(p / 720.0F, cover_, 3);
        const float undulation = 0.5F + 0.5F * gradientNoise(glm::vec3(x + 0.4F * z, 0.0F, z) / 420.0F, waves_ + 16U);
        const float inset = 0.5F * kWidth - std::sqrt(std::sqrt(x * x * x * x + z * z * z * z));  // a rounded square
        const float outline = inset - 130.0F + 330.0F * fractalNoise(p / 460.0F, cover_ + 8U, 5);
        const float rim = smoothRamp(-0.4F, 1.0F, outline / 260.0F);
        const float wanted =
            400.0F * (cell - 0.67F) + 330.0F * cover + 40.0F * undulation + 45.0F - 230.0F * (1.0F - rim);
        constexpr float ceiling = kHeight - 45.0F;  // an inversion, which caps the deck softly
        const float thickness = wanted > 0.0F ? ceiling * (1.0F - std::exp(-wanted / ceiling)) : wanted;
        const float base = 16.0F + 14.0F * fractalNoise(bent / 180.0F, waves_ + 24U, 3);
        // well below the base at the rim, so that turbulence finds nothing to tear off there
        return {base, base + glm::mix(-90.0F, thickness, smoothRamp(0.0F, 120.0F, inset))};
    }

    float density(const glm::vec3& p, const Column& column, float voxelHeight) const {
        const float thickness = column.top - column.base;
        constexpr float tear = 26.0F;  // metres by which turbulence moves the surfaces
        if (thickness <= -tear || p.y < column.base - tear || p.y > column.top + tear) return 0.0F;
        const float billow =
            22.0F * (billowNoise(p / 58.0F, fine_) - 0.7F) + 9.0F * (billowNoise(p / 26.0F, fine_ + 1U) - 0.7F);
        const float noise = 20.0F * fractalNoise(p / 62.0F, fine_ + 2U, 4);
        const float above = p.y - column.base + 0.5F * noise;
        const float below = column.top - p.y + billow + noise;
        const float soft = std::max(15.0F, 1.5F * voxelHeight);
        const float shape = smoothRamp(-0.8F * soft, 0.8F * soft, above) * smoothRamp(-0.5F * soft, 0.5F * soft, below);
        const float height = glm::mix(0.4F, 0.85F, glm::clamp(above / 140.0F, 0.0F, 1.0F));
        return glm::clamp(shape * height * (1.0F + 0.3F * noise / 20.0F), 0.0F, 1.0F);
    }

  private:
    std::uint32_t cells_, cover_, waves_, fine_;
};

}  // namespace

Volume makeStratus(int resolution, std::uint64_t seed, const Report& report) {
    constexpr double flattening = 2.0;  // a thin deck needs its voxels where it is thin
    Volume volume = makeBox("stratus", glm::dvec3(kWidth, kHeight, kWidth), resolution, flattening);
    const Stratus stratus(seed);
    const auto voxelHeight = static_cast<float>(volume.toWorld.linear[1][1]);
    fillSlices(volume, report, [&](int z) {
        for (int x = 1; x < volume.size.x - 1; ++x) {
            const glm::vec3 foot = voxelCentre(volume, x, 0, z);
            const Column column = stratus.column(foot.x, foot.z);
            for (int y = 1; y < volume.size.y - 1; ++y) {
                volume.density[volume.index(x, y, z)] =
                    stratus.density(voxelCentre(volume, x, y, z), column, voxelHeight);
            }
        }
    });
    return volume;
}

}  // namespace lumulus::vdb
