#pragma once

#include <string>
#include <utility>
#include <vector>

#include "service/render/render_config.h"
#include "service/values/results.h"

namespace lumulus::service {

/// The folders of the server, which its clients need not know: replies name a file of them as they do.
class ServerPaths {
  public:
    explicit ServerPaths(const RenderConfig& config);

    /// Text in which a file of the folder of scenes goes by its name there, and an upload as "upload sha256:…".
    std::string hidden(std::string text) const;
    /// The same for all that a reply tells in words.
    void hide(Reply& reply) const;

  private:
    std::vector<std::pair<std::string, std::string>> replacements_;  // longest first
};

}  // namespace lumulus::service
