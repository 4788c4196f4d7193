#include "prefilter/brdf_table.h"

#include <tbb/parallel_for.h>

#include "surface/material/energy.h"

namespace lumulus::prefilter {

LayeredImage brdfTable(BrdfModel model, int size, const Check& check) {
    LayeredImage table;
    table.width = table.height = size;
    std::vector<float>&scale = table.layer("R"), &bias = table.layer("G");
    const bool ggx = model == BrdfModel::ggx;
    const material::Microfacets kind = ggx ? material::Microfacets::ggx : material::Microfacets::beckmann;
    tbb::parallel_for(0, size, [&](int row) {
        check();
        const double roughness = (row + 0.5) / size;
        for (int x = 0; x < size; ++x) {
            const material::SplitSum sum =
                material::splitSum(kind, (x + 0.5) / size, ggx ? roughness * roughness : roughness);
            const auto at =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
            scale[at] = static_cast<float>(sum.scale);
            bias[at] = static_cast<float>(sum.bias);
        }
    });
    return table;
}

}  // namespace lumulus::prefilter
