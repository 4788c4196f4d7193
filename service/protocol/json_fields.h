#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "service/values/request_error.h"

namespace lumulus::service {

/// Parses JSON text that holds an object; empty text is an empty object. Errors: RequestError `bad_request` for text
/// that is no JSON object, that nests deeper than 16, or that has a key twice in one object.
nlohmann::json parseObject(std::string_view text);

/// Reads the fields of one JSON object. Every getter names the field in its error (RequestError `bad_request`) where it
/// has the wrong type, is out of range or is not finite. finish() refuses fields that no getter has read.
class JsonFields {
  public:
    /// `object` must outlive this. `path` is the place of the object in the request, as "camera"; empty at the top.
    JsonFields(const nlohmann::json& object, std::string path);

    std::optional<double> number(const char* name, double low, double high);
    std::optional<std::int64_t> integer(const char* name, std::int64_t low, std::int64_t high);
    std::optional<bool> flag(const char* name);
    std::optional<std::string> text(const char* name, std::size_t longest);
    /// Errors, besides the others': the field is missing.
    std::string requiredText(const char* name, std::size_t longest);
    std::uint64_t requiredCount(const char* name, std::uint64_t most);
    /// The id of a message: a whole number of 64 bits, or its decimal digits as text, for languages whose numbers are
    /// doubles.
    std::uint64_t requiredId(const char* name);
    /// A whole number up to `most`, or a name.
    std::optional<std::variant<std::uint32_t, std::string>> indexOrName(const char* name, std::uint32_t most,
                                                                        std::size_t longest);
    /// Index into `choices`.
    std::optional<std::size_t> choice(const char* name, std::initializer_list<std::string_view> choices);
    std::optional<std::vector<double>> numbers(const char* name, std::size_t count, double low, double high);
    std::optional<glm::dvec3> vector(const char* name, double low, double high);
    std::optional<std::vector<std::string>> texts(const char* name, std::size_t most, std::size_t longest);
    const nlohmann::json* object(const char* name);
    const nlohmann::json* array(const char* name, std::size_t most);

    /// "camera.position"
    std::string place(std::string_view name) const;
    void finish() const;

  private:
    const nlohmann::json* find(const char* name);

    const nlohmann::json& object_;
    std::string path_;
    std::vector<std::string_view> known_;
};

}  // namespace lumulus::service
