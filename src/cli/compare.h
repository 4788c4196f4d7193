#pragma once

#include <filesystem>

namespace lumulus::cli {

struct CompareOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    std::filesystem::path secondReference;  ///< empty, or an independent one: the references' noise drops out
    std::filesystem::path denominator;  ///< empty for the reference, or a picture that relative errors are relative to
    std::filesystem::path diff;         ///< empty, or where the difference goes: false colours (.png), I − R (.exr)
    double exposure = 0.0;              ///< stops, of the tone-mapped pictures that FLIP sees
    bool json = false;
};

/// `lumulus compare`: how far a picture is from a reference. Errors: InputError for pictures that do not fit.
void runCompare(const CompareOptions& options);

}  // namespace lumulus::cli
