#include "vdb/choose_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "vdb/grid_rank.h"

namespace lumulus::vdb {
namespace {

/// A name between quotes, with the spaces that it begins or ends with.
std::string quoted(const std::string& name) {
    constexpr std::size_t longest = 80;
    return shortened(oneLine("\"" + name + "\""), longest);
}

/// `density[1]` as a name and a number.
struct NumberedName {
    std::string name;
    std::size_t number = 0;
};

std::optional<NumberedName> numbered(const std::string& plain) {
    const std::size_t open = plain.rfind('[');
    if (open == std::string::npos || !plain.ends_with(']')) return std::nullopt;
    std::size_t number = 0;
    const char* first = plain.data() + open + 1;
    const char* last = plain.data() + plain.size() - 1;
    const auto [end, failure] = std::from_chars(first, last, number);
    if (first == last || end != last || failure != std::errc()) return std::nullopt;
    return NumberedName{plainName(plain.substr(0, open)), number};
}

class Chooser {
  public:
    Chooser(std::span<const GridLabel> grids, const std::string& file, const std::string& key)
        : grids_(grids), file_(file), key_(key) {}

    GridChoice named(const std::string& wanted) {
        const std::vector<std::size_t> found = called(wanted);
        const std::size_t chosen = found.size() > 1 ? firstOfSeveral(found) : found.front();
        requireDensity(chosen);
        return {chosen, std::move(warnings_)};
    }

    GridChoice best() {
        std::vector<std::size_t> usable;
        for (std::size_t i = 0; i < grids_.size(); ++i)
            if (isUsable(grids_[i])) usable.push_back(i);
        if (usable.empty()) refuseAll();
        const auto rank = [&](std::size_t i) { return nameRank(grids_[i].name); };
        std::ranges::stable_sort(usable, {}, rank);
        std::size_t chosen = usable.front();
        const auto filled = std::ranges::find_if(usable, [&](std::size_t i) {
            // where there is no choice nothing has to be read
            return rank(i) < otherQuantity && (usable.size() < 2 || grids_[i].hasContent());
        });
        if (filled != usable.end() && *filled != chosen) {
            warn(fmt::format("grid {} is empty: grid {} is taken; {} chooses another", quoted(grids_[chosen].name),
                             quoted(grids_[*filled].name), key_));
            chosen = *filled;
        } else if (rank(chosen) == otherQuantity) {
            warn(fmt::format("no grid has the name of a density: grid {} is taken as one; {} chooses another of {}",
                             quoted(grids_[chosen].name), key_, list()));
        } else if (rank(chosen) == 0 && grids_[chosen].name != "density") {
            warn(fmt::format("grid {} is taken as \"density\"", quoted(grids_[chosen].name)));
        } else if (rank(chosen) > 0) {
            warn(fmt::format("no grid is called \"density\": grid {} is taken; {} chooses another of {}",
                             quoted(grids_[chosen].name), key_, list()));
        }
        warnOfNamesakes(chosen);
        return {chosen, std::move(warnings_)};
    }

  private:
    static bool isUsable(const GridLabel& grid) { return grid.isScalar && !grid.levelSet; }

    void warn(const std::string& text) { warnings_.push_back(file_ + ": " + text); }

    std::string list() const {
        constexpr std::size_t most = 8;
        std::string text;
        for (std::size_t i = 0; i < std::min(grids_.size(), most); ++i)
            text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", quoted(grids_[i].name), oneLine(grids_[i].type));
        return grids_.size() > most ? fmt::format("{} and {} more", text, grids_.size() - most) : text;
    }

    template <typename Condition>
    std::vector<std::size_t> where(const Condition& condition) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < grids_.size(); ++i)
            if (condition(grids_[i].name)) found.push_back(i);
        return found;
    }

    /// The grids of a name: first as it is written, then in any case, then with a number behind it. Never none.
    std::vector<std::size_t> called(const std::string& wanted) const {
        std::vector<std::size_t> found = where([&](const std::string& name) { return name == wanted; });
        const std::string plain = plainName(wanted);
        const auto namesakes = [&](const std::string& of) {
            return where([&](const std::string& name) { return plainName(name) == of; });
        };
        if (found.empty()) found = namesakes(plain);
        if (!found.empty()) return found;
        if (const auto several = numbered(plain)) {
            found = namesakes(several->name);
            if (several->number < found.size()) return {found[several->number]};
            if (!found.empty())
                throw InputError(
                    fmt::format("the file has {} grids of the name {}", found.size(), quoted(several->name)), file_,
                    fmt::format("count them from 0: \"{}[{}]\" is the last", several->name, found.size() - 1));
        }
        throw InputError(fmt::format("the file has no grid {}", quoted(wanted)), file_, "choose one of " + list());
    }

    std::size_t firstOfSeveral(const std::vector<std::size_t>& found) {
        const auto usable = std::ranges::find_if(found, [&](std::size_t i) { return isUsable(grids_[i]); });
        const std::size_t chosen = usable == found.end() ? found.front() : *usable;
        warnOfNamesakes(chosen);
        return chosen;
    }

    /// Warns where grids of the chosen one's name were passed over.
    void warnOfNamesakes(std::size_t chosen) {
        const std::string plain = plainName(grids_[chosen].name);
        const std::vector<std::size_t> all = where([&](const std::string& name) { return plainName(name) == plain; });
        if (all.size() < 2) return;
        const auto number = static_cast<std::size_t>(std::ranges::find(all, chosen) - all.begin());
        warn(fmt::format("{} grids are called {}: number {}, counted from 0, is taken; {} = \"{}[{}]\" takes another",
                         all.size(), quoted(plain), number, key_, plain, number == 0 ? 1 : 0));
    }

    void requireDensity(std::size_t chosen) const {
        const GridLabel& grid = grids_[chosen];
        if (!grid.isScalar)
            throw InputError(
                fmt::format("grid {} holds values of type {}, not float", quoted(grid.name), oneLine(grid.type)), file_,
                "choose a float grid of " + list());
        if (grid.levelSet)
            throw InputError(fmt::format("grid {} is a level set, not a density", quoted(grid.name)), file_,
                             "convert it to a fog volume (OpenVDB's sdfToFogVolume)");
    }

    [[noreturn]] void refuseAll() const {
        const auto levelSet = std::ranges::find_if(grids_, &GridLabel::isScalar);
        if (levelSet != grids_.end()) requireDensity(static_cast<std::size_t>(levelSet - grids_.begin()));
        throw InputError("the file has no float grid, but " + list(), file_, "save the density as a float grid");
    }

    std::span<const GridLabel> grids_;
    const std::string& file_;
    const std::string& key_;
    std::vector<std::string> warnings_;
};

}  // namespace

GridChoice chooseGrid(std::span<const GridLabel> grids, const std::string& wanted, const std::string& file,
                      const std::string& key) {
    Chooser chooser(grids, file, key);
    return wanted.empty() ? chooser.best() : chooser.named(wanted);
}

}  // namespace lumulus::vdb
