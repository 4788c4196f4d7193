#pragma once

#include <string>

namespace lumulus::scene {

/// docs/scene-format.md, made from the table of keys.
std::string sceneFormatMarkdown();

}  // namespace lumulus::scene
