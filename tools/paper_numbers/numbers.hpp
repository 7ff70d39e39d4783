#pragma once
// What each paper states, beside what this software gives.

#include <string>

namespace kinebus::papers {

/// Rows of a table "quantity, paper, here"; counts what lies outside what is allowed.
class Table {
 public:
  explicit Table(const char* title);
  /// A number that must agree within `tolerance`.
  void compare(const std::string& what, double paper, double here, double tolerance, const char* unit);
  /// A bound that must hold.
  void below(const std::string& what, double bound, double here, const char* unit);
  void above(const std::string& what, double bound, double here, const char* unit);
  void note(const std::string& words);
  int wrong() const { return wrong_; }

 private:
  void row(const std::string& what, const std::string& paper, double here, const char* unit, bool good);
  int wrong_ = 0;
};

/// Each returns how many numbers do not agree. `folder`: pictures go there; empty: none.
int m1(const std::string& folder);
int m4(const std::string& folder);
int m5(const std::string& folder);

void write_picture(const std::string& folder, const char* name, const std::string& svg);
/// The four closures of M4 for the inputs of its table 6.
std::string draw_m4_assemblies();

}  // namespace kinebus::papers
