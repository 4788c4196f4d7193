#pragma once

#include <vector>

#include "service/protocol/json_fields.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Reads the list `clouds` of a change: what becomes of single clouds. Empty without it. Errors: RequestError
/// `bad_request`.
std::vector<CloudEdit> readCloudEdits(JsonFields& fields);

}  // namespace lumulus::service
