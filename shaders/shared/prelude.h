// First include of every header that is compiled both as C++ and as GLSL.
// C++ sees GLM's vectors; GLSL its own. Interface structs use scalar layout: sizes agree with C++ without padding
// rules.
#ifndef LUMULUS_SHARED_PRELUDE_H
#define LUMULUS_SHARED_PRELUDE_H

#ifdef __cplusplus
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace lumulus::shared {
using glm::bvec3;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
using uint64_t = std::uint64_t;
using int64_t = std::int64_t;
// plain `sqrt` would be the double one
using glm::abs;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::inversesqrt;
using glm::log;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::sin;
using glm::sqrt;
}  // namespace lumulus::shared

#define SHARED_BEGIN namespace lumulus::shared {
#define SHARED_END }
#define SHARED_FN inline
#define INOUT(T) T&
#define OUT(T) T&
#define OUT_ARRAY(T, name, count) T(&name)[count]
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FN
#define INOUT(T) inout T
#define OUT(T) out T
#define OUT_ARRAY(T, name, count) out T name[count]
#endif

#endif
