#pragma once

#include "service/protocol/json_fields.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Read the fields of a request that describe pictures. Errors: RequestError.
CameraRequest readCamera(JsonFields& fields);
LightChange readLight(JsonFields& fields);
FrameRequest readFrame(JsonFields& fields, const RequestLimits& limits);

/// Fields `encoding`, `quality`, `exposure`, `hash`.
PictureFormat readFormat(JsonFields& fields);

}  // namespace lumulus::service
