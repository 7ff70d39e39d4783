#include "gui/views/number_field.hpp"

#include <QAbstractSpinBox>
#include <QChar>
#include <QLatin1Char>
#include <QLocale>
#include <QRegularExpression>
#include <QToolTip>
#include <cmath>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

constexpr qsizetype kLongest = 12;

/// The figure as a C program writes it: digits of any script, comma and point alike, every minus sign;
/// without marks of direction and spaces.
QString plain(const QString& figure) {
  constexpr char16_t kMinus = 0x2212, kArabicDecimal = 0x066B;
  QString out;
  for (const QChar c : figure) {
    if (c.isSpace() || c.category() == QChar::Other_Format) continue;
    if (c.digitValue() >= 0)
      out += QChar(u'0' + c.digitValue());
    else if (c == QLatin1Char(',') || c == QChar(kArabicDecimal))
      out += QLatin1Char('.');
    else if (c == QChar(kMinus))
      out += QLatin1Char('-');
    else
      out += c;
  }
  return out;
}

}  // namespace

NumberField::NumberField(QWidget* parent) : QDoubleSpinBox(parent) {
  setButtonSymbols(QAbstractSpinBox::NoButtons);
  setKeyboardTracking(false);
  setFocusPolicy(Qt::StrongFocus);  // not by the wheel
  setCorrectionMode(QAbstractSpinBox::CorrectToPreviousValue);
  setLocale(QLocale());
}

QString NumberField::figure(const QString& text) const {
  QString given = text;
  if (!suffix().isEmpty() && given.endsWith(suffix())) given.chop(suffix().size());
  return given.trimmed();
}

std::optional<double> NumberField::number(const QString& text) const {
  bool is_number = false;
  const double value = plain(figure(text)).toDouble(&is_number);
  if (!is_number || !std::isfinite(value)) return std::nullopt;
  const double scale = std::pow(10.0, decimals());  // a digit too many is rounded
  return std::round(value * scale) / scale;
}

QString NumberField::refusal(const QString& text) const {
  return tr("%1 is not within %2 to %3")
      .arg(Format::isolated(figure(text)), Format::isolated(locale().toString(minimum(), 'f', decimals())),
           Format::isolated(locale().toString(maximum(), 'f', decimals()) + suffix()));
}

double NumberField::valueFromText(const QString& text) const {
  return number(text).value_or(value());
}

QValidator::State NumberField::validate(QString& text, int&) const {
  static const QRegularExpression kFigure(QStringLiteral(R"(\A[-+]?\d*\.?\d*\z)"));
  const QString given = plain(figure(text));
  if (!kFigure.match(given).hasMatch() || given.size() > kLongest) return QValidator::Invalid;
  const auto value = number(text);
  if (!value) return QValidator::Intermediate;
  // What is out of range may be typed to its end: it is judged when it is whole.
  return *value >= minimum() && *value <= maximum() ? QValidator::Acceptable : QValidator::Intermediate;
}

/// Of a figure that is not taken.
void NumberField::fixup(QString& text) const {
  if (!number(text)) return;  // left empty: the former value, without a word
  const QString words = refusal(text);
  QToolTip::showText(mapToGlobal(rect().bottomLeft()), words);
  emit refused(words);
}

void NumberField::wheelEvent(QWheelEvent* event) {
  if (hasFocus())
    QDoubleSpinBox::wheelEvent(event);
  else
    event->ignore();  // the page scrolls
}

void NumberField::changeEvent(QEvent* event) {
  // A widget keeps the locale that it was made in.
  if (event->type() == QEvent::LanguageChange) setLocale(QLocale());
  QDoubleSpinBox::changeEvent(event);
}

}  // namespace kinebus::gui
