#pragma once

#include <string_view>

namespace lumulus::scene {

/// Refuses text whose dotted keys nest deeper than in any scene. The TOML parser limits the nesting of values but not
/// of keys, and its tables are destroyed recursively, so that a hostile file could exhaust the stack. `source` names
/// the text in messages. Errors: InputError.
void checkKeyDepth(std::string_view text, std::string_view source);

}  // namespace lumulus::scene
