#pragma once

#include <cstddef>
#include <vector>

#include "service/protocol/json_fields.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Reads a query: its product and rectangle, and the coordinates in its payload (doubles, little-endian). Errors:
/// RequestError that names the field, or the row of a coordinate that is not finite or beyond 1e9 m.
QueryRequest readQuery(JsonFields& fields, const std::vector<std::byte>& payload);

}  // namespace lumulus::service
