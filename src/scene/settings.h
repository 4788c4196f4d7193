#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "base/error.h"
#include "scene/animation.h"
#include "scene/arrays.h"
#include "scene/schema.h"
#include "scene/toml.h"

namespace lumulus::scene {

/// One key with the value that the file or an override gives it.
struct Setting {
    const Key* key = nullptr;
    const toml::node* node = nullptr;  ///< lives in the Settings
    std::string where;                 ///< "scenes/x.toml:14, cloud.0.albedo" or "--set cloud.0.albedo"
    bool fromFile = true;
    std::size_t entry = 0;  ///< index in its array section
};

/// A key or section that does not exist.
struct UnknownKey : InputError {
    UnknownKey(const std::string& theWhat, const std::string& theWhere, const std::string& mend)
        : InputError(theWhat, theWhere, mend), what_(theWhat), where_(theWhere) {}

    std::string what_, where_;  ///< without the mend, for whoever knows a better one
};

/// All keys that the file and the overrides set, by path ("cloud.0.albedo"). Overrides replace the file's values.
class Settings {
  public:
    /// Adds the keys of a TOML document. Errors: InputError for bad TOML and for keys that do not exist.
    void addFile(std::string_view text, const std::string& source);
    /// `section.key=value`, the value as TOML or else as a bare string. An entry of an array is given by its index or
    /// by its `name`. An override of one of two alternatives (`sun.azimuth`, `sun.direction_to`) takes the file's other
    /// one out. Errors: InputError.
    void addOverride(std::string_view text);
    /// Sets the keys of an animation to their values at a frame, before any override. Errors: InputError.
    void addAnimation(const Animation& animation, double frame);
    /// The section [animate] of the file; null where there is none.
    const toml::node* animation() const { return documents_.empty() ? nullptr : documents_.front().get("animate"); }

    const std::map<std::string, Setting>& all() const { return settings_; }
    const Setting* find(const std::string& path) const;
    /// Number of entries of an array section; where nothing is said about it, those that are implied, or `implied`.
    std::size_t entries(std::string_view array) const;
    std::size_t entries(std::string_view array, std::size_t implied) const;

  private:
    struct Origin;
    void collect(const toml::node& node, const std::string& path, const std::string& name, const Origin& origin);
    void collectEntries(const ArraySection& array, const toml::node& node, const Origin& origin);
    std::string byIndex(const ArraySection& array, const std::string& path) const;
    std::string overriddenName(const ArraySection& array, const std::string& path);
    void put(const std::string& path, Setting setting);

    std::deque<toml::table> documents_;  // a deque: nodes stay where they are
    std::map<std::string, Setting> settings_;
    std::map<std::string, std::size_t, std::less<>> entries_;  ///< by array section
};

}  // namespace lumulus::scene
