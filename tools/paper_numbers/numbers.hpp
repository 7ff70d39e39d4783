#pragma once
// What each paper prints, what follows from its equations, and what this software gives.

#include <optional>
#include <string>

#include "gateway/description/machine_description.hpp"

namespace kinebus::papers {

/// Rows "quantity, paper prints, follows from the paper, here"; counts what lies outside what is allowed.
///
/// Only a number that stands in the paper is in the first column, and only one that was calculated from the
/// paper's equations without this software's kinematics in the second. What was fed in and is found again is
/// `ours`: no agreement with anybody.
class Table {
 public:
  explicit Table(const char* title);
  /// A number of the paper, beside what its own equations give where that is another calculation.
  void compare(const std::string& what, std::optional<double> prints, std::optional<double> follows,
               double here, double tolerance, const char* unit);
  /// A rule of the paper, in its words. One that is not kept is said, and is no error: the machine file is
  /// not the paper's machine.
  void rule(const std::string& what, const std::string& prints, double here, bool kept, const char* unit);
  /// A number that is only ours; the second with a bound that it must keep.
  void ours(const std::string& what, double here, const char* unit);
  void ours(const std::string& what, double here, double bound, const char* unit);
  void note(const std::string& words);
  int wrong() const { return wrong_; }

 private:
  void row(const std::string& what, const std::string& prints, const std::string& follows, double here,
           const char* unit, const std::string& remark);
  int wrong_ = 0;
};

/// A shipped machine file by its name.
MachineDescription shipped(const char* name);

/// Each returns how many numbers do not agree. `folder`: pictures go there; empty: none.
int m1(const std::string& folder);
int m4(const std::string& folder);
int m5(const std::string& folder);

/// M4's path of its table 4 (figure 10): rows into `table`, the picture into `folder`.
void m4_path(Table& table, const MachineDescription& machine, const std::string& folder);

void write_text(const std::string& folder, const char* name, const std::string& text);
/// The same, and says so; nothing without a folder.
void write_picture(const std::string& folder, const char* name, const std::string& svg);
/// The four closures of M4 for the inputs of its table 6.
std::string draw_m4_assemblies(const M4Geometry& geometry);

}  // namespace kinebus::papers
