#pragma once
// Messages held against their text form: all fields that are there, and no others.

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <string>

namespace kinebus {

/// Of all fields that are there, in the order of their numbers.
template <typename Message>
std::string text_of(const Message& message) {
  std::string text;
  google::protobuf::TextFormat::Printer printer;
  printer.SetSingleLineMode(true);
  printer.PrintToString(message, &text);
  return text;
}
template <typename Message>
void expect_says(const Message& message, const std::string& text) {
  Message expected;
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &expected)) << text;
  EXPECT_EQ(text_of(message), text_of(expected));
}

}  // namespace kinebus
