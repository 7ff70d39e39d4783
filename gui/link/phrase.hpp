#pragma once
// Words that are kept and shown again and again: in the language at work whenever they are said.

#include <QCoreApplication>
#include <QString>
#include <QStringList>

namespace kinebus::gui {

class Phrase {
 public:
  Phrase() = default;
  /// `source` in QT_TRANSLATE_NOOP(context, source), with %1, %2 ... for the parts.
  Phrase(const char* context, const char* source, QStringList parts = {})
      : context_(context), source_(source), parts_(std::move(parts)) {}
  /// A name, or words of the system: nobody translates them.
  Phrase(const QString& text) : parts_(text) {}  // NOLINT(google-explicit-constructor)

  QString said() const {
    if (source_ == nullptr) return parts_.join(QString());
    QString words = QCoreApplication::translate(context_, source_);
    for (const QString& part : parts_) words = words.arg(part);
    return words;
  }
  bool empty() const { return source_ == nullptr && said().isEmpty(); }
  friend bool operator==(const Phrase&, const Phrase&) = default;

 private:
  const char* context_ = nullptr;
  const char* source_ = nullptr;
  QStringList parts_;
};

}  // namespace kinebus::gui
