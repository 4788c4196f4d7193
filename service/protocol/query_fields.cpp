#include "service/protocol/query_fields.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

namespace lumulus::service {

namespace {

constexpr double farthest = 1e9;  // metres
constexpr std::int64_t mostAcross = 4096;

QueryProduct readProduct(JsonFields& fields) {
    constexpr std::size_t longest = 40;
    const auto products = fields.texts("products", 1, longest).value_or(std::vector<std::string>{});
    const std::string name = products.empty() ? "" : products.front();
    if (name == "segments") return QueryProduct::segments;
    if (name == "sun") return QueryProduct::sun;
    if (name == "ground_shadow") return QueryProduct::groundShadow;
    if (name == "ambient") return QueryProduct::ambient;
    throw RequestError("bad_request", "products must be one of segments, sun, ground_shadow, ambient in a list",
                       "products");
}

std::vector<double> readCoordinates(const std::vector<std::byte>& payload, std::size_t columns, std::size_t most) {
    const std::size_t row = columns * sizeof(double);
    if (payload.empty() || payload.size() % row != 0)
        throw RequestError("bad_request", "the payload must be " + std::to_string(columns) + " doubles a row");
    if (payload.size() / row > most)
        throw RequestError("too_large", "such a query may hold " + std::to_string(most) + " rows");
    std::vector<double> numbers(payload.size() / sizeof(double));
    std::memcpy(numbers.data(), payload.data(), payload.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!(std::abs(numbers[i]) <= farthest))
            throw RequestError("bad_request", "coordinates must be finite and within ±1e9 m",
                               "row " + std::to_string(i / columns));
    return numbers;
}

void readRectangle(JsonFields& fields, QueryRequest& query) {
    const auto corners = fields.numbers("rectangle", 4, -farthest, farthest);
    if (!corners || !((*corners)[0] < (*corners)[2] && (*corners)[1] < (*corners)[3]))
        throw RequestError("bad_request", "rectangle must be [x0, z0, x1, z1] with x0 < x1 and z0 < z1", "rectangle");
    query.rectangle = *corners;
    query.y = fields.number("y", -farthest, farthest);
    query.width = static_cast<int>(fields.integer("width", 1, mostAcross).value_or(query.width));
    query.height = static_cast<int>(fields.integer("height", 1, mostAcross).value_or(query.height));
    if (static_cast<std::size_t>(query.width) * static_cast<std::size_t>(query.height) > mostQueryWays)
        throw RequestError("too_large", "a shadow may hold " + std::to_string(mostQueryWays) + " pixels", "width");
}

}  // namespace

QueryRequest readQuery(JsonFields& fields, const std::vector<std::byte>& payload) {
    QueryRequest query;
    query.product = readProduct(fields);
    if (query.product != QueryProduct::groundShadow) {
        const bool ambient = query.product == QueryProduct::ambient;
        query.numbers = readCoordinates(payload, query.product == QueryProduct::segments ? 6 : 3,
                                        ambient ? mostAmbientPoints : mostQueryWays);
        return query;
    }
    if (!payload.empty()) throw RequestError("bad_request", "a ground_shadow takes no payload");
    readRectangle(fields, query);
    return query;
}

}  // namespace lumulus::service
