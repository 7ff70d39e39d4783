#include "gui/scene/path_features.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace kinebus::gui {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return c == '-' || c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  });
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

// The first that is found in the words counts.
constexpr std::array<std::pair<std::string_view, PathFeature>, 29> kWords{{
    {"support", PathFeature::kSupport},
    {"bridge", PathFeature::kBridge},
    {"overhang", PathFeature::kOuterWall},
    {"gap", PathFeature::kGap},
    {"thin wall", PathFeature::kGap},
    {"ironing", PathFeature::kGap},
    {"skirt", PathFeature::kSkirt},
    {"brim", PathFeature::kSkirt},
    {"raft", PathFeature::kSkirt},
    {"prime", PathFeature::kSkirt},
    {"wipe", PathFeature::kSkirt},
    {"ooze", PathFeature::kSkirt},
    {"wall outer", PathFeature::kOuterWall},
    {"outer wall", PathFeature::kOuterWall},
    {"external perimeter", PathFeature::kOuterWall},
    {"outer perimeter", PathFeature::kOuterWall},
    {"wall inner", PathFeature::kInnerWall},
    {"inner wall", PathFeature::kInnerWall},
    {"perimeter", PathFeature::kInnerWall},
    {"top surface", PathFeature::kSolid},
    {"bottom surface", PathFeature::kSolid},
    {"solid", PathFeature::kSolid},
    {"skin", PathFeature::kSolid},
    {"top", PathFeature::kSolid},
    {"bottom", PathFeature::kSolid},
    {"internal infill", PathFeature::kInfill},
    {"infill", PathFeature::kInfill},
    {"fill", PathFeature::kInfill},
    {"sparse", PathFeature::kInfill},
}};

}  // namespace

PathFeature feature_named(std::string_view words) {
  const std::string name = lower(trimmed(words));
  for (const auto& [word, feature] : kWords)
    if (name.find(word) != std::string::npos) return feature;
  return PathFeature::kOther;
}

void FeatureScanner::add(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (!begun_ && end > 0) {
      begun_ = true;
      comment_ = text.front() == ';';
    }
    if (comment_ && head_.size() <= kLongest)
      head_.append(text.substr(0, std::min(end, kLongest + 1 - head_.size())));
    if (end == text.size()) return;
    end_line();
    text.remove_prefix(end + 1);
  }
}

void FeatureScanner::end_line() {
  static constexpr std::array<std::string_view, 4> kMarks{";type:", "; feature:", ";feature:", "; feature "};
  if (comment_ && head_.size() <= kLongest) {
    const std::string line = lower(head_);
    for (const std::string_view mark : kMarks)
      if (line.starts_with(mark)) {
        const PathFeature feature = feature_named(line.substr(mark.size()));
        if (changes_.empty() || changes_.back().feature != feature) changes_.push_back({line_, feature});
        break;
      }
  }
  head_.clear();
  comment_ = begun_ = false;
  ++line_;
}

std::vector<FeatureScanner::Change> FeatureScanner::finish() {
  end_line();
  return std::move(changes_);
}

}  // namespace kinebus::gui
