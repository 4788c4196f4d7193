#include "service/render/exposure_desk.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/exposure.h"
#include "scene/tone.h"

namespace lumulus::service {

double Adaptation::follow(double metered, Clock::time_point now) {
    constexpr double secondsToBright = 0.5, secondsToDark = 2.0;
    if (value_) {
        const double passed = std::max(0.0, std::chrono::duration<double>(now - last_).count());
        const double time = metered > *value_ ? secondsToBright : secondsToDark;
        *value_ = metered + (*value_ - metered) * std::exp(-passed / time);
    } else {
        value_ = metered;
    }
    last_ = now;
    return *value_;
}

Tone ExposureDesk::toneOf(const scene::Image& image, const Job& job, const std::vector<ViewResult>& views,
                          bool lightOfNow, Clock::time_point now) {
    std::vector<const LayeredImage*> pictures;
    for (const ViewResult& view : views) pictures.push_back(&view.image);
    Tone tone = scene::toneOf(image, pictures);
    if (image.exposureMode != scene::ExposureMode::automatic) return tone;
    if (!lightOfNow)
        tone.gain = gainWithout(pictures).value_or(tone.gain);
    else
        remember(tone.gain, pictures);
    if (!job.stream) return tone;
    forgetOld(now);
    tone.gain = gainOfEv100(streams_[{job.client, job.id}].follow(ev100OfGain(tone.gain), now));
    return tone;
}

/// The gain of pictures whose clouds have another light than what is behind them; nothing where none is known.
std::optional<double> ExposureDesk::gainWithout(const std::vector<const LayeredImage*>& pictures) const {
    const std::optional<double> behind = backgroundGain(pictures);
    return behind ? *behind * cloudsOverSky_ : gain_;
}

void ExposureDesk::remember(double gain, const std::vector<const LayeredImage*>& pictures) {
    gain_ = gain;
    if (const std::optional<double> behind = backgroundGain(pictures)) cloudsOverSky_ = gain / *behind;
}

void ExposureDesk::forgetOld(Clock::time_point now) {
    constexpr auto longest = std::chrono::seconds(30);  // after which nobody remembers
    std::erase_if(streams_, [&](const auto& stream) { return now - stream.second.last() > longest; });
}

}  // namespace lumulus::service
