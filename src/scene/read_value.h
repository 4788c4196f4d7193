#pragma once

#include <string>

#include "scene/schema.h"
#include "scene/toml.h"

namespace lumulus::scene {

/// Reads the value of `key` from `node` and checks its type, range and choices. `where` names file, line and key in
/// messages. Errors: InputError.
Value readValue(const toml::node& node, const Key& key, const std::string& where);

/// Name of the type of a node for messages: "a string", "a table", …
std::string nodeTypeText(const toml::node& node);

}  // namespace lumulus::scene
