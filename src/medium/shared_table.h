#pragma once

#include <memory>
#include <vector>

namespace lumulus::phase {

/// A table that never changes, shared by all copies: thousands of instances are made of the same medium.
class SharedTable {
  public:
    SharedTable() = default;
    SharedTable(std::vector<float> values) : values_(std::make_shared<const std::vector<float>>(std::move(values))) {}

    const std::vector<float>& values() const { return *values_; }
    operator const std::vector<float>&() const { return *values_; }
    bool empty() const { return values_->empty(); }
    std::size_t size() const { return values_->size(); }
    const float* data() const { return values_->data(); }
    float operator[](std::size_t i) const { return (*values_)[i]; }
    auto begin() const { return values_->begin(); }
    auto end() const { return values_->end(); }
    bool operator==(const SharedTable& other) const { return values_ == other.values_ || *values_ == *other.values_; }

  private:
    std::shared_ptr<const std::vector<float>> values_ = std::make_shared<const std::vector<float>>();
};

}  // namespace lumulus::phase
