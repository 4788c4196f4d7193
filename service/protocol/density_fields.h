#pragma once

#include <optional>

#include "service/protocol/json_fields.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Reads what another density a change asks for; none where it asks for none. Errors: RequestError `bad_request`.
std::optional<NewDensity> readDensity(JsonFields& fields);

}  // namespace lumulus::service
