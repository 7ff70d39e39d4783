#include "gui/session/gateway_words.hpp"

#include <QChar>
#include <QCoreApplication>
#include <QLocale>
#include <QRegularExpression>
#include <QRegularExpressionMatch>

namespace kinebus::gui {
namespace {

/// Deeper ones are nobody's sentences.
constexpr int kDeepest = 8;

/// Numbers and names keep their order within a right-to-left sentence.
QString isolated(const QString& text) {
  return QChar(0x2066) + text + QChar(0x2069);
}

/// "0.720" or "-12.5 mm", a measure that stands for itself, with the digits of the language.
QString measure(const QString& text) {
  static const QRegularExpression kMeasure(QStringLiteral("^([-+]?\\d+)\\.(\\d+)( \\D+)?$"));
  const QRegularExpressionMatch match = kMeasure.match(text);
  if (!match.hasMatch()) return text;
  return QLocale().toString(text.left(match.capturedEnd(2)).toDouble(), 'f',
                            static_cast<int>(match.capturedLength(2))) +
         match.captured(3);
}

QString say(const joblink::Sentence& sentence, int depth) {
  if (sentence.verbatim()) return isolated(QString::fromStdString(sentence.text()));
  const QString pattern = QCoreApplication::translate("Gateway", sentence.text().c_str());
  // In one pass: what stands in a part is never taken for a place.
  QString text;
  for (qsizetype i = 0; i < pattern.size(); ++i) {
    const int place = pattern[i] == u'%' && i + 1 < pattern.size() ? pattern[i + 1].unicode() - u'1' : -1;
    if (place < 0 || place >= sentence.parts_size() || depth == kDeepest) {
      text += pattern[i];
      continue;
    }
    const joblink::Sentence& part = sentence.parts(place);
    // The 38.2 of "G%1" is a name.
    const bool stands_alone = text.isEmpty() || !(text.back().isLetterOrNumber() || text.back() == u'#');
    text += part.verbatim() && stands_alone ? isolated(measure(QString::fromStdString(part.text())))
                                            : say(part, depth + 1);
    ++i;
  }
  return text;
}

}  // namespace

QString GatewayWords::said(const joblink::Sentence& sentence, const std::string& words) {
  if (sentence.text().empty()) return QString::fromStdString(words);
  // A text of the job as a whole needs no isolation.
  if (sentence.verbatim()) return QString::fromStdString(sentence.text());
  return say(sentence, 0);
}

QString GatewayWords::said(const joblink::Problem& problem) {
  QString words = said(problem.rule_said(), problem.rule());
  if (!problem.place().empty())
    words.prepend(isolated(QString::fromStdString(problem.place())) + QStringLiteral(": "));
  if (!problem.expected().empty())
    words += QStringLiteral("; ") + QCoreApplication::translate("GatewayWords", "expected %1")
                                        .arg(said(problem.expected_said(), problem.expected()));
  return words;
}

}  // namespace kinebus::gui
