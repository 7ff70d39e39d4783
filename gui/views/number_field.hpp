#pragma once
// A field for a number that never changes by accident: the wheel turns it only while it has the focus, and a
// number out of range is refused as a whole instead of being cut to its first digits. Comma and point are
// both the decimal sign, and all digits count, whatever the language: it shows those of the language.

#include <QDoubleSpinBox>
#include <QEvent>
#include <QString>
#include <QValidator>
#include <QWheelEvent>
#include <optional>

namespace kinebus::gui {

class NumberField : public QDoubleSpinBox {
  Q_OBJECT
 public:
  explicit NumberField(QWidget* parent = nullptr);
  /// `text` with what the field takes: "400 is not within 0 to 120 °C".
  QString refusal(const QString& text) const;
  double valueFromText(const QString& text) const override;

 signals:
  /// A number was given that the field does not take; it has its former value again.
  void refused(const QString& words) const;

 protected:
  QValidator::State validate(QString& text, int& position) const override;
  void fixup(QString& text) const override;
  void wheelEvent(QWheelEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  /// What stands before the unit.
  QString figure(const QString& text) const;
  /// With as many decimals as the field has; nullopt: no number, or not yet one.
  std::optional<double> number(const QString& text) const;
};

}  // namespace kinebus::gui
