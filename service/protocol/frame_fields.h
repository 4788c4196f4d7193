#pragma once

#include "service/protocol/json_fields.h"
#include "service/protocol/requests.h"

namespace lumulus::service {

/// The parts of requests that speak of pictures. Errors: RequestError.
CameraRequest readCamera(JsonFields& fields);
LightChange readLight(JsonFields& fields);
FrameRequest readFrame(JsonFields& fields, const RequestLimits& limits);

/// Fields `encoding`, `quality`, `exposure`, `hash`.
struct EncodingFields {
    Encoding encoding = Encoding::half;
    int quality = 85;
    std::optional<double> exposure;
    bool hash = true;
};
EncodingFields readEncoding(JsonFields& fields);

}  // namespace lumulus::service
