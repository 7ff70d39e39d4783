#pragma once
// What is wrong with a job, and where. Collected before anything moves.

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/sentence.hpp"

namespace kinebus {

struct Problem {
  enum class Severity : std::uint8_t { kError, kWarning };
  Severity severity = Severity::kError;
  std::uint32_t line = 0;    ///< of the job, from 1; 0: the job as a whole
  std::uint32_t column = 0;  ///< from 1; 0: the whole line
  Sentence words;            ///< the rule that is violated, what was found, what is allowed
};

/// Problems in the order of the job, at most `capacity` kept; the rest is only counted.
class ProblemList {
 public:
  explicit ProblemList(std::size_t capacity = 300) : capacity_(capacity) {}
  void add(Problem problem) {
    (problem.severity == Problem::Severity::kError ? errors_ : warnings_)++;
    if (problems_.size() < capacity_) problems_.push_back(std::move(problem));
  }
  /// Says it of the problem added last in other words, where it was kept.
  void reword_last(Sentence words) {
    if (!truncated() && !problems_.empty()) problems_.back().words = std::move(words);
  }
  const std::vector<Problem>& all() const { return problems_; }
  std::uint64_t errors() const { return errors_; }
  std::uint64_t warnings() const { return warnings_; }
  bool truncated() const { return errors_ + warnings_ > problems_.size(); }

 private:
  std::size_t capacity_;
  std::vector<Problem> problems_;
  std::uint64_t errors_ = 0;
  std::uint64_t warnings_ = 0;
};

}  // namespace kinebus
