#pragma once

#include <toml++/toml.h>
#include <string>

#include "scene/schema.h"

namespace lumulus::scene {

/// What `node` says for `key`, checked: its type, its range, its choices. `where` names file, line and key in messages.
/// Errors: InputError.
Value readValue(const toml::node& node, const Key& key, const std::string& where);

/// "a string", "a table", …
std::string nodeTypeText(const toml::node& node);

}  // namespace lumulus::scene
