#include "light/fog_light/stack.h"

#include <cmath>

namespace lumulus::fog_light {

double truncatedShare(double g) {
    return std::pow(g, momentCount);
}

Stack makeStack(const std::vector<FogLayer>& layers, const std::vector<double>& levels, int channel) {
    Stack stack;
    const std::size_t count = levels.size() - 1;
    stack.scattered.assign(layers.size(), std::vector<double>(count, 0.0));
    std::vector<std::vector<double>> phases;
    for (const FogLayer& layer : layers) phases.push_back(layer.moments(momentCount));
    for (std::size_t i = 0; i < count; ++i) {
        double depth = 0.0, emission = 0.0;
        std::vector<double> moments(momentCount, 0.0);
        for (std::size_t n = 0; n < layers.size(); ++n) {
            const FogLayer& layer = layers[n];
            const double column = layer.column(levels[i], levels[i + 1]), straight = layer.truncated();
            const double scattering = layer.scattering[channel] * column;
            depth += scattering * (1.0 - straight) + layer.absorption[channel] * column;
            emission += layer.emission[channel] * column;
            stack.scattered[n][i] = scattering;
            for (std::size_t l = 0; l < moments.size(); ++l) moments[l] += scattering * (phases[n][l] - straight);
        }
        const double per = depth > 0.0 ? 1.0 / depth : 0.0;
        for (double& moment : moments) moment *= per;
        for (auto& scattered : stack.scattered) scattered[i] *= per;
        stack.depth.push_back(depth);
        stack.moments.push_back(std::move(moments));
        stack.emitted.push_back(emission * per);
    }
    stack.above.assign(levels.size(), 0.0);
    for (std::size_t k = count; k-- > 0;) stack.above[k] = stack.above[k + 1] + stack.depth[k];
    return stack;
}

}  // namespace lumulus::fog_light
