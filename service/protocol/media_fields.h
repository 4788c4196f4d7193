#pragma once

#include <vector>

#include "service/protocol/json_fields.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Reads the changes of fog media that a request lists; none where it has no list. What values may be is for the keys
/// of a scene to say. Errors: RequestError `bad_request`.
std::vector<MediumEdit> readMedia(JsonFields& fields);

}  // namespace lumulus::service
