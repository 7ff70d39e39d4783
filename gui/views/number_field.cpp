#include "gui/views/number_field.hpp"

#include <QAbstractSpinBox>
#include <QLocale>
#include <QToolTip>

#include "gui/models/format.hpp"

namespace kinebus::gui {

NumberField::NumberField(QWidget* parent) : QDoubleSpinBox(parent) {
  setButtonSymbols(QAbstractSpinBox::NoButtons);
  setKeyboardTracking(false);
  setFocusPolicy(Qt::StrongFocus);  // not by the wheel
  setCorrectionMode(QAbstractSpinBox::CorrectToPreviousValue);
}

QString NumberField::refusal(const QString& text) const {
  QString given = text;
  if (!suffix().isEmpty() && given.endsWith(suffix())) given.chop(suffix().size());
  return tr("%1 is not within %2 to %3")
      .arg(Format::isolated(given.trimmed()), Format::isolated(locale().toString(minimum(), 'f', decimals())),
           Format::isolated(locale().toString(maximum(), 'f', decimals()) + suffix()));
}

QValidator::State NumberField::validate(QString& text, int& position) const {
  const auto state = QDoubleSpinBox::validate(text, position);
  if (state != QValidator::Invalid) return state;
  QString figure = text;
  if (!suffix().isEmpty() && figure.endsWith(suffix())) figure.chop(suffix().size());
  bool is_number = false;
  locale().toDouble(figure.trimmed(), &is_number);
  // A number of too many digits may be typed to its end: what it is worth is judged when it is whole.
  return is_number && figure.size() < 12 ? QValidator::Intermediate : state;
}

void NumberField::fixup(QString& text) const {
  QDoubleSpinBox::fixup(text);
  int position = 0;
  QString again = text;
  if (again.isEmpty() || validate(again, position) == QValidator::Acceptable) return;
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

}  // namespace kinebus::gui
