#include "gateway/sessions/http/kinebus/message_json.hpp"

#include <google/protobuf/util/json_util.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus::http {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

/// Of a double, as short as it can be read back.
template <typename Number>
void append_chars(std::string& out, Number value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  out.append(digits.data(), end.ptr);
}

void append_text(std::string& out, std::string_view text) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  // What needs no escape goes in whole runs: nearly all of it.
  std::size_t run = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto code = static_cast<unsigned char>(text[at]);
    if (code >= 0x20 && code != '"' && code != '\\') continue;
    out.append(text, run, at - run);
    run = at + 1;
    if (code >= 0x20)
      out.append(1, '\\').append(1, text[at]);
    else if (code == '\n')
      out += "\\n";
    else
      out.append("\\u00").append(1, kHex[code >> 4U]).append(1, kHex[code & 15U]);
  }
  out.append(text, run).append(1, '"');
}

void append_base64(std::string& out, std::string_view bytes) {
  static constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  out += '"';
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned three = 0;
    for (std::size_t i = 0; i < 3; ++i)
      three = three << 8U | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      out += at + i <= bytes.size() ? kLetters[three >> (18 - 6 * i) & 63U] : '=';
  }
  out += '"';
}

void append_number(std::string& out, double value) {
  if (std::isfinite(value))
    append_chars(out, value);
  else
    out += std::isnan(value) ? "\"NaN\"" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"";
}

/// The field's value, or its `index`th; index < 0: it is not a list. `r`: the message's, which costs a look
/// at what all threads share.
void append_value(std::string& out, const Message& message, const Reflection& r, const FieldDescriptor& field,
                  int index) {
  const bool one = index < 0;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      append_chars(out, one ? r.GetInt32(message, &field) : r.GetRepeatedInt32(message, &field, index));
      break;
    case FieldDescriptor::CPPTYPE_UINT32:
      append_chars(out, one ? r.GetUInt32(message, &field) : r.GetRepeatedUInt32(message, &field, index));
      break;
    case FieldDescriptor::CPPTYPE_INT64:
      out += '"';
      append_chars(out, one ? r.GetInt64(message, &field) : r.GetRepeatedInt64(message, &field, index));
      out += '"';
      break;
    case FieldDescriptor::CPPTYPE_UINT64:
      out += '"';
      append_chars(out, one ? r.GetUInt64(message, &field) : r.GetRepeatedUInt64(message, &field, index));
      out += '"';
      break;
    case FieldDescriptor::CPPTYPE_DOUBLE:
      append_number(out, one ? r.GetDouble(message, &field) : r.GetRepeatedDouble(message, &field, index));
      break;
    case FieldDescriptor::CPPTYPE_FLOAT:
      append_number(out, static_cast<double>(one ? r.GetFloat(message, &field)
                                                 : r.GetRepeatedFloat(message, &field, index)));
      break;
    case FieldDescriptor::CPPTYPE_BOOL:
      out +=
          (one ? r.GetBool(message, &field) : r.GetRepeatedBool(message, &field, index)) ? "true" : "false";
      break;
    case FieldDescriptor::CPPTYPE_ENUM: {
      const int number =
          one ? r.GetEnumValue(message, &field) : r.GetRepeatedEnumValue(message, &field, index);
      const auto* value = field.enum_type()->FindValueByNumber(number);
      if (value != nullptr)
        append_text(out, value->name());
      else
        append_chars(out, number);
      break;
    }
    case FieldDescriptor::CPPTYPE_STRING: {
      std::string scratch;
      const std::string& text = one ? r.GetStringReference(message, &field, &scratch)
                                    : r.GetRepeatedStringReference(message, &field, index, &scratch);
      if (field.type() == FieldDescriptor::TYPE_BYTES)
        append_base64(out, text);
      else
        append_text(out, text);
      break;
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      append_json(out, one ? r.GetMessage(message, &field) : r.GetRepeatedMessage(message, &field, index));
      break;
  }
}

}  // namespace

void append_json(std::string& text, const Message& message) {
  const auto& type = *message.GetDescriptor();
  const Reflection& reflection = *message.GetReflection();
  char between = '{';
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (!field.is_repeated() && field.has_presence() && !reflection.HasField(message, &field)) continue;
    text.append(1, between).append(1, '"').append(field.name()).append("\":");
    between = ',';
    if (!field.is_repeated()) {
      append_value(text, message, reflection, field, -1);
      continue;
    }
    text += '[';
    const int count = reflection.FieldSize(message, &field);
    for (int k = 0; k < count; ++k) {
      if (k > 0) text += ',';
      append_value(text, message, reflection, field, k);
    }
    text += ']';
  }
  if (between == '{') text += '{';
  text += '}';
}

std::string to_json(const Message& message) {
  std::string text;
  append_json(text, message);
  return text;
}

Result<void, std::string> from_json(std::string_view text, Message& message) {
  const auto read = google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message);
  if (read.ok()) return {};
  return Error<std::string>(shown({read.message().data(), read.message().size()}));
}

}  // namespace kinebus::http
