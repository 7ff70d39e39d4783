#pragma once
// Text of Prometheus's exposition format 0.0.4 (prometheus.io/docs/instrumenting/exposition_formats).

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace kinebus::http {

class Exposition {
 public:
  using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// What follows are samples of this one. A gauge goes up and down; a counter only up while the daemon
  /// lives.
  Exposition& gauge(std::string_view name, std::string_view help) { return family(name, "gauge", help); }
  Exposition& counter(std::string_view name, std::string_view help) { return family(name, "counter", help); }
  /// A value that is no number is left out: that is what "not known" is there.
  Exposition& sample(double value, Labels labels = {});

  std::string take() { return std::move(text_); }

 private:
  Exposition& family(std::string_view name, std::string_view type, std::string_view help);

  std::string text_;
  std::string_view name_;
};

}  // namespace kinebus::http
