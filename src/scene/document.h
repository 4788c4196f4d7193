#pragma once

#include <string>

namespace lumulus::scene {

/// The text of docs/scene-format.md, made from the table of keys.
std::string sceneFormatMarkdown();

}  // namespace lumulus::scene
