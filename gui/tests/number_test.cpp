// Numbers as people type them, in every language.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QString>
#include <QStringList>

#include "gui/views/language.hpp"
#include "gui/views/number_field.hpp"

namespace kinebus::gui {
namespace {

class NumberTest : public testing::Test {
 protected:
  NumberTest() {
    field.setRange(-20, 300);
    field.setDecimals(2);
    field.setSuffix(QStringLiteral(" mm"));
    QObject::connect(&field, &NumberField::refused, &field,
                     [this](const QString& words) { refusals << words; });
  }
  ~NumberTest() override { language.apply(QStringLiteral("en")); }

  void speak(const QString& code) {
    language.apply(code);
    QApplication::sendPostedEvents();
    // Only windows hear of it; a field in one is told by it.
    QEvent change(QEvent::LanguageChange);
    QApplication::sendEvent(&field, &change);
  }
  /// What the field holds after `text` was typed over all of it.
  double typed(const QString& text) {
    field.setValue(7);
    field.selectAll();
    for (const QChar c : text) {
      QKeyEvent press(QEvent::KeyPress, 0, Qt::NoModifier, QString(c));
      QApplication::sendEvent(&field, &press);
    }
    QKeyEvent enter(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier);
    QApplication::sendEvent(&field, &enter);
    return field.value();
  }
  Language language;
  NumberField field;
  QStringList refusals;
};

TEST_F(NumberTest, CommaAndPointAreBothTheDecimalSignInEveryLanguage) {
  for (const auto& choice : Language::choices()) {
    speak(choice.code);
    for (const char16_t* text : {u"1,5", u"1.5", u"۱٫۵", u"1٫5", u"+1,50"})
      EXPECT_DOUBLE_EQ(typed(QString::fromUtf16(text)), 1.5)
          << choice.code.toStdString() << ' ' << QString::fromUtf16(text).toStdString();
    EXPECT_DOUBLE_EQ(typed(QStringLiteral("-2,25")), -2.25) << choice.code.toStdString();
    EXPECT_DOUBLE_EQ(typed(QString::fromUtf16(u"\u22122,25")), -2.25) << choice.code.toStdString();
    // What it shows itself it takes as well.
    field.setValue(-12.75);
    const QString shown = field.text();
    EXPECT_DOUBLE_EQ(typed(shown), -12.75) << shown.toStdString();
  }
  EXPECT_TRUE(refusals.isEmpty()) << refusals.join(QLatin1Char('|')).toStdString();
}

TEST_F(NumberTest, ItShowsTheSignOfItsLanguageAlsoAfterASwitch) {
  field.setValue(1.5);
  speak(QStringLiteral("tr"));
  EXPECT_EQ(field.text(), QStringLiteral("1,50 mm"));
  speak(QStringLiteral("en"));
  EXPECT_EQ(field.text(), QStringLiteral("1.50 mm"));
  speak(QStringLiteral("fa"));
  EXPECT_EQ(field.text(), QString::fromUtf16(u"۱٫۵۰ mm"));
}

TEST_F(NumberTest, ASignThatTheFieldDoesNotTakeIsNotLeftOut) {
  speak(QStringLiteral("en"));
  field.setMinimum(0);
  EXPECT_DOUBLE_EQ(typed(QStringLiteral("-5")), 7) << "5 is not what was typed";
  ASSERT_EQ(refusals.size(), 1);
  EXPECT_TRUE(refusals.front().contains(QStringLiteral("-5"))) << refusals.front().toStdString();
  EXPECT_TRUE(refusals.front().contains(QStringLiteral("300.00 mm"))) << refusals.front().toStdString();
  // 20.5 of whole degrees is 21, not 205.
  field.setDecimals(0);
  EXPECT_DOUBLE_EQ(typed(QStringLiteral("20,5")), 21);
  EXPECT_DOUBLE_EQ(typed(QStringLiteral("301")), 7);
  EXPECT_EQ(refusals.size(), 2);
}

TEST_F(NumberTest, LeftEmptyItHasItsFormerValueWithoutAWord) {
  speak(QStringLiteral("en"));
  EXPECT_DOUBLE_EQ(typed(QStringLiteral("-")), 7);
  EXPECT_TRUE(refusals.isEmpty());
}

}  // namespace
}  // namespace kinebus::gui
