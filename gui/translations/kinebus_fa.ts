<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="fa" sourcelanguage="en">
<context>
    <name>ConsoleHints</name>
    <message>
        <source>traverse</source>
        <translation>جابه‌جایی سریع</translation>
    </message>
    <message>
        <source>straight line at feed</source>
        <translation>خط راست با سرعت پیشروی</translation>
    </message>
    <message>
        <source>arc, clockwise</source>
        <translation>کمان، ساعت‌گرد</translation>
    </message>
    <message>
        <source>arc, counter-clockwise</source>
        <translation>کمان، پادساعت‌گرد</translation>
    </message>
    <message>
        <source>home, or go to the bed reference</source>
        <translation>خانه‌یابی یا رفتن به مرجع بستر</translation>
    </message>
    <message>
        <source>first work coordinate system</source>
        <translation>دستگاه مختصات کاری نخست</translation>
    </message>
    <message>
        <source>second work coordinate system</source>
        <translation>دستگاه مختصات کاری دوم</translation>
    </message>
    <message>
        <source>absolute positions</source>
        <translation>موقعیت‌های مطلق</translation>
    </message>
    <message>
        <source>relative positions</source>
        <translation>موقعیت‌های نسبی</translation>
    </message>
    <message>
        <source>call this position so</source>
        <translation>تنظیم موقعیت کنونی</translation>
    </message>
    <message>
        <source>motors on</source>
        <translation>موتورها روشن</translation>
    </message>
    <message>
        <source>motors off</source>
        <translation>موتورها خاموش</translation>
    </message>
    <message>
        <source>list the jobs</source>
        <translation>فهرست کارها</translation>
    </message>
    <message>
        <source>choose a job</source>
        <translation>انتخاب کار</translation>
    </message>
    <message>
        <source>start or resume</source>
        <translation>آغاز یا ادامه</translation>
    </message>
    <message>
        <source>pause</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>progress of the job</source>
        <translation>پیشرفت کار</translation>
    </message>
    <message>
        <source>time of the job</source>
        <translation>زمان کار</translation>
    </message>
    <message>
        <source>extruder absolute</source>
        <translation>اکسترودر مطلق</translation>
    </message>
    <message>
        <source>extruder relative</source>
        <translation>اکسترودر نسبی</translation>
    </message>
    <message>
        <source>heat the nozzle</source>
        <translation>گرم کردن نازل</translation>
    </message>
    <message>
        <source>temperatures</source>
        <translation>دماها</translation>
    </message>
    <message>
        <source>fan on</source>
        <translation>فن روشن</translation>
    </message>
    <message>
        <source>fan off</source>
        <translation>فن خاموش</translation>
    </message>
    <message>
        <source>heat the nozzle and wait</source>
        <translation>گرم کردن نازل و انتظار</translation>
    </message>
    <message>
        <source>emergency stop</source>
        <translation>توقف اضطراری</translation>
    </message>
    <message>
        <source>position</source>
        <translation>موقعیت</translation>
    </message>
    <message>
        <source>name and capabilities</source>
        <translation>نام و توانایی‌ها</translation>
    </message>
    <message>
        <source>switches</source>
        <translation>کلیدها</translation>
    </message>
    <message>
        <source>heat the bed</source>
        <translation>گرم کردن بستر</translation>
    </message>
</context>
<context>
    <name>Desk</name>
    <message>
        <source>Demo machine</source>
        <translation>ماشین نمایشی</translation>
    </message>
</context>
<context>
    <name>Format</name>
    <message>
        <source>%1 B</source>
        <translation>%1 B</translation>
    </message>
    <message>
        <source>%1 kB</source>
        <translation>%1 kB</translation>
    </message>
    <message>
        <source>%1 MB</source>
        <translation>%1 MB</translation>
    </message>
    <message>
        <source>%1 GB</source>
        <translation>%1 GB</translation>
    </message>
    <message>
        <source>%1/s</source>
        <translation>%1/s</translation>
    </message>
    <message>
        <source>%1 °C</source>
        <translation>%1 °C</translation>
    </message>
</context>
<context>
    <name>Gateway</name>
    <message>
        <source>the centre of the arc is its start</source>
        <translation>مرکز کمان همان نقطهٔ آغاز آن است</translation>
    </message>
    <message>
        <source>the arc&apos;s end is %1 from the centre, its start %2 (they may differ by %3)</source>
        <translation>پایان کمان %1 از مرکز دور است و آغاز آن %2 (اختلاف مجاز %3 است)</translation>
    </message>
    <message>
        <source>an arc with R needs an end other than its start; a full circle needs I, J or K</source>
        <translation>کمان با R باید پایانی جدا از آغاز داشته باشد؛ دایرهٔ کامل I یا J یا K می‌خواهد</translation>
    </message>
    <message>
        <source>R must not be 0</source>
        <translation>R نمی‌تواند 0 باشد</translation>
    </message>
    <message>
        <source>the arc&apos;s ends are %1 apart, more than twice R (%2)</source>
        <translation>دو سر کمان %1 از هم دورند، بیش از دو برابر R (%2)</translation>
    </message>
    <message>
        <source>% stands alone in its line</source>
        <translation>% در خط خود تنها می‌ایستد</translation>
    </message>
    <message>
        <source>N needs a whole number from 0 to 4294967295</source>
        <translation>N عددی درست از 0 تا 4294967295 می‌خواهد</translation>
    </message>
    <message>
        <source>/ (block delete) must be the first character of the line</source>
        <translation>/ (حذف بلوک) باید نخستین نویسهٔ خط باشد</translation>
    </message>
    <message>
        <source>byte %1 is not G-code</source>
        <translation>بایت %1 در G-code جایی ندارد</translation>
    </message>
    <message>
        <source>expected a letter before &apos;%1&apos;</source>
        <translation>پیش از &apos;%1&apos; حرفی انتظار می‌رفت</translation>
    </message>
    <message>
        <source>comments in ( ) cannot hold another (</source>
        <translation>توضیح درون ( ) نمی‌تواند ( دیگری داشته باشد</translation>
    </message>
    <message>
        <source>the comment needs a closing )</source>
        <translation>توضیح به ) پایانی نیاز دارد</translation>
    </message>
    <message>
        <source>expected = after the parameter</source>
        <translation>پس از پارامتر = انتظار می‌رفت</translation>
    </message>
    <message>
        <source>%1 cannot be used in a turned coordinate system (G10 R)</source>
        <translation>%1 در دستگاه مختصات چرخیده (G10 R) به کار نمی‌رود</translation>
    </message>
    <message>
        <source>G30 means a probe to printers and a stored position to mills: keep one with G30.1 before it, or use G53 G0 with coordinates</source>
        <translation>G30 در چاپگرها پروب و در فرزها موقعیت ذخیره‌شده است: پیش از آن با G30.1 موقعیتی نگه دارید، یا G53 G0 با مختصات به کار ببرید</translation>
    </message>
    <message>
        <source>%1 needs G49 and G69: machine coordinates do not turn with the part</source>
        <translation>%1 به G49 و G69 نیاز دارد: مختصات ماشین با قطعه نمی‌چرخد</translation>
    </message>
    <message>
        <source>G10 needs L1, L2, L10, L11 or L20 (or no L: retract)</source>
        <translation>G10 به L1، L2، L10، L11 یا L20 نیاز دارد (بدون L: عقب‌کشی)</translation>
    </message>
    <message>
        <source>G10 L%1 needs the tool P</source>
        <translation>G10 L%1 به ابزار P نیاز دارد</translation>
    </message>
    <message>
        <source>too many tools are changed by G10 (1000 at most)</source>
        <translation>G10 ابزارهای زیادی را عوض می‌کند (حداکثر 1000)</translation>
    </message>
    <message>
        <source>@ and ^ cannot stand beside X and Y</source>
        <translation>@ و ^ در کنار X و Y نمی‌آیند</translation>
    </message>
    <message>
        <source>@ and ^ cannot stand beside %1</source>
        <translation>@ و ^ در کنار %1 نمی‌آیند</translation>
    </message>
    <message>
        <source>@ and ^ need the plane of X and Y (G17)</source>
        <translation>@ و ^ به صفحهٔ X و Y (G17) نیاز دارند</translation>
    </message>
    <message>
        <source>under G91 @ and ^ cannot start at the zero point, where there is no angle</source>
        <translation>در G91، @ و ^ از نقطهٔ صفر که زاویه ندارد آغاز نمی‌شوند</translation>
    </message>
    <message>
        <source>constant surface speed (G96) needs a spindle, which this machine does not have</source>
        <translation>سرعت برشی ثابت (G96) اسپیندل می‌خواهد که این ماشین ندارد</translation>
    </message>
    <message>
        <source>G96 needs S, the surface speed</source>
        <translation>G96 به S، سرعت برشی، نیاز دارد</translation>
    </message>
    <message>
        <source>the highest speed D of G96 must be greater than 0</source>
        <translation>بیشترین سرعت D در G96 باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>%1 stands twice in the line</source>
        <translation>%1 در خط دو بار آمده است</translation>
    </message>
    <message>
        <source>too many assignments in one line (32 at most)</source>
        <translation>مقداردهی در یک خط زیاد است (حداکثر 32)</translation>
    </message>
    <message>
        <source>a checksum needs a line number (N) at the line&apos;s beginning</source>
        <translation>جمع کنترلی به شمارهٔ خط (N) در آغاز خط نیاز دارد</translation>
    </message>
    <message>
        <source>a checksum is a number from 0 to 255</source>
        <translation>جمع کنترلی عددی از 0 تا 255 است</translation>
    </message>
    <message>
        <source>nothing can follow the checksum</source>
        <translation>پس از جمع کنترلی چیزی نمی‌آید</translation>
    </message>
    <message>
        <source>the checksum is %1, not %2</source>
        <translation>جمع کنترلی %1 است، نه %2</translation>
    </message>
    <message>
        <source>G needs a number</source>
        <translation>G عدد می‌خواهد</translation>
    </message>
    <message>
        <source>M needs a number</source>
        <translation>M عدد می‌خواهد</translation>
    </message>
    <message>
        <source>%1 is too large (10^9 at most)</source>
        <translation>%1 بسیار بزرگ است (حداکثر 10^9)</translation>
    </message>
    <message>
        <source>%1 stands twice in the line (first at column %2)</source>
        <translation>%1 در خط دو بار آمده است (بار نخست در ستون %2)</translation>
    </message>
    <message>
        <source>G codes are 0 to 999.9 with one decimal place at most</source>
        <translation>کدهای G از 0 تا 999.9 و حداکثر یک رقم اعشار دارند</translation>
    </message>
    <message>
        <source>%1 and %2 (column %3) are of one modal group: only one can stand in a line</source>
        <translation>%1 و %2 (ستون %3) از یک گروه حالت‌اند: در هر خط تنها یکی می‌آید</translation>
    </message>
    <message>
        <source>M codes are whole numbers</source>
        <translation>کدهای M عدد درست‌اند</translation>
    </message>
    <message>
        <source>%1 and M%2 (column %3) exclude one another: only one can stand in a line</source>
        <translation>%1 و M%2 (ستون %3) با هم نمی‌آیند: در هر خط تنها یکی</translation>
    </message>
    <message>
        <source>too many M codes in one line (8 at most)</source>
        <translation>کد M در یک خط زیاد است (حداکثر 8)</translation>
    </message>
    <message>
        <source>G68.3 is not supported: use G68.2 with I J K</source>
        <translation>G68.3 پشتیبانی نمی‌شود: G68.2 با I J K به کار ببرید</translation>
    </message>
    <message>
        <source>feed for each turn (G95) needs a spindle, which this machine does not have</source>
        <translation>پیشروی در هر دور (G95) اسپیندل می‌خواهد که این ماشین ندارد</translation>
    </message>
    <message>
        <source>M3 turns a spindle, which this machine does not have</source>
        <translation>M3 اسپیندل را می‌چرخاند که این ماشین ندارد</translation>
    </message>
    <message>
        <source>M4 turns a spindle, which this machine does not have</source>
        <translation>M4 اسپیندل را می‌چرخاند که این ماشین ندارد</translation>
    </message>
    <message>
        <source>%1 is unknown</source>
        <translation>%1 ناشناخته است</translation>
    </message>
    <message>
        <source>this is binary G-code (.bgcode): have the slicer write it as text</source>
        <translation>این G-code دودویی (.bgcode) است: بگذارید برش‌دهنده آن را به شکل متن بنویسد</translation>
    </message>
    <message>
        <source>this is a ZIP archive (3MF or similar): unpack the G-code in it first</source>
        <translation>این یک بایگانی ZIP (3MF یا مانند آن) است: نخست G-code درون آن را بیرون بیاورید</translation>
    </message>
    <message>
        <source>this is a gzip archive: unpack it first</source>
        <translation>این یک بایگانی gzip است: نخست آن را باز کنید</translation>
    </message>
    <message>
        <source>this text is UTF-16: save it as UTF-8</source>
        <translation>این متن UTF-16 است: آن را به شکل UTF-8 ذخیره کنید</translation>
    </message>
    <message>
        <source>%1 more lines are refused for reasons named above</source>
        <translation>%1 خط دیگر نیز به دلیل‌های یادشده پذیرفته نشد</translation>
    </message>
    <message>
        <source>the line is longer than 4096 bytes</source>
        <translation>خط از 4096 بایت درازتر است</translation>
    </message>
    <message>
        <source>%1 has no effect on this machine</source>
        <translation>%1 در این ماشین اثری ندارد</translation>
    </message>
    <message>
        <source>there is no shaper %1; known are none, zv, mzv, zvd, zvdd, zvddd, ei, ei2 (2hump_ei), ei3 (3hump_ei)</source>
        <translation>شکل‌دهنده‌ای به نام %1 نیست؛ شناخته‌شده‌ها none، zv، mzv، zvd، zvdd، zvddd، ei، ei2 (2hump_ei)، ei3 (3hump_ei) هستند</translation>
    </message>
    <message>
        <source>a shaper for %1 Hz; allowed are %2 to %3 Hz, or 0 for none</source>
        <translation>شکل‌دهنده برای %1 هرتز؛ مجاز %2 تا %3 هرتز است، یا 0 برای هیچ</translation>
    </message>
    <message>
        <source>a shaper for a damping ratio of %1; allowed are 0 to %2</source>
        <translation>شکل‌دهنده برای نسبت میرایی %1؛ مجاز 0 تا %2 است</translation>
    </message>
    <message>
        <source>%1 with %2 is not supported: X Y Z, F in Hz, D or S for the damping, P&quot;shaper&quot;</source>
        <translation>%1 با %2 پشتیبانی نمی‌شود: X Y Z، F به هرتز، D یا S برای میرایی، P&quot;شکل‌دهنده&quot;</translation>
    </message>
    <message>
        <source>%1 knows no %2: SHAPER_TYPE, SHAPER_FREQ and DAMPING_RATIO, with _X, _Y or _Z behind them</source>
        <translation>%1 واژهٔ %2 را نمی‌شناسد: SHAPER_TYPE، SHAPER_FREQ و DAMPING_RATIO، با _X، _Y یا _Z پشت آن‌ها</translation>
    </message>
    <message>
        <source>K%1 is on the scale of linear advance 1.0 (Marlin before 1.1.9), which says nothing in seconds: write K in s, 0 to %2, or leave it to advance_s in [pressure_advance]</source>
        <translation>K%1 در مقیاس linear advance 1.0 است (مارلین پیش از 1.1.9) که به ثانیه معنایی ندارد: K را به ثانیه، 0 تا %2، بنویسید یا آن را به advance_s در [pressure_advance] بسپارید</translation>
    </message>
    <message>
        <source>a shaper without a frequency: neither the job nor [vibration] has said one</source>
        <translation>شکل‌دهنده‌ای بدون بسامد: نه کار و نه [vibration] بسامدی گفته است</translation>
    </message>
    <message>
        <source>different shapers on a machine that turns or tilts the part: one shaper for X, Y and Z is needed</source>
        <translation>شکل‌دهنده‌های متفاوت در ماشینی که قطعه را می‌چرخاند یا کج می‌کند: یک شکل‌دهنده برای X، Y و Z لازم است</translation>
    </message>
    <message>
        <source>%1 and %2 would both use the line&apos;s axis words: write them in two lines</source>
        <translation>%1 و %2 هر دو واژه‌های محور این خط را به کار می‌برند: در دو خط بنویسید</translation>
    </message>
    <message>
        <source>%1 can only be read</source>
        <translation>%1 تنها خواندنی است</translation>
    </message>
    <message>
        <source>offsets cannot change in a tilted plane: end it with G69 first</source>
        <translation>در صفحهٔ شیب‌دار مبدأ عوض نمی‌شود: نخست با G69 پایانش دهید</translation>
    </message>
    <message>
        <source>the offset is too large (10^9 at most)</source>
        <translation>جابه‌جایی مبدأ بسیار بزرگ است (حداکثر 10^9)</translation>
    </message>
    <message>
        <source>too many named parameters (1000 at most)</source>
        <translation>پارامترهای نام‌دار زیادند (حداکثر 1000)</translation>
    </message>
    <message>
        <source>the machine has no axis %1; its axes are X Y Z A C and E</source>
        <translation>ماشین محور %1 ندارد؛ محورهایش X Y Z A C و E هستند</translation>
    </message>
    <message>
        <source>%1 has no use in this line: no motion code is given or active</source>
        <translation>%1 در این خط کاری ندارد: کد حرکت نه داده شده و نه فعال است</translation>
    </message>
    <message>
        <source>%1 has no use in this line</source>
        <translation>%1 در این خط کاری ندارد</translation>
    </message>
    <message>
        <source>two codes of this line would both use %1: write them in two lines</source>
        <translation>دو کد این خط هر دو %1 را به کار می‌برند: در دو خط بنویسید</translation>
    </message>
    <message>
        <source>%1 needs a number</source>
        <translation>%1 عدد می‌خواهد</translation>
    </message>
    <message>
        <source>tool H%1 has no length here: gcode.tool_length_mm of the machine file gives it one, or G10 L1 P%1 Z in the job</source>
        <translation>ابزار H%1 اینجا طولی ندارد: gcode.tool_length_mm در پروندهٔ ماشین یا G10 L1 P%1 Z در کار به آن طول می‌دهد</translation>
    </message>
    <message>
        <source>%1 must be a whole number from %2 to %3</source>
        <translation>%1 باید عددی درست از %2 تا %3 باشد</translation>
    </message>
    <message>
        <source>the expression is nested too deep (40 levels at most)</source>
        <translation>عبارت بیش از اندازه تودرتو است (حداکثر 40 لایه)</translation>
    </message>
    <message>
        <source>expected a number, #parameter, [expression] or function</source>
        <translation>عدد، #پارامتر، [عبارت] یا تابع انتظار می‌رفت</translation>
    </message>
    <message>
        <source>expected an operator or ]</source>
        <translation>عملگر یا ] انتظار می‌رفت</translation>
    </message>
    <message>
        <source>the expression has no finite value</source>
        <translation>عبارت مقدار متناهی ندارد</translation>
    </message>
    <message>
        <source>division by zero</source>
        <translation>تقسیم بر صفر</translation>
    </message>
    <message>
        <source>the operation has no finite result</source>
        <translation>نتیجهٔ عمل متناهی نیست</translation>
    </message>
    <message>
        <source>%1 is not defined for this value</source>
        <translation>%1 برای این مقدار تعریف نشده است</translation>
    </message>
    <message>
        <source>atan is written atan[y]/[x]</source>
        <translation>atan چنین نوشته می‌شود: atan[y]/[x]</translation>
    </message>
    <message>
        <source>atan[0]/[0] is not defined</source>
        <translation>atan[0]/[0] تعریف نشده است</translation>
    </message>
    <message>
        <source>exists is written exists[#&lt;name&gt;]</source>
        <translation>exists چنین نوشته می‌شود: exists[#&lt;name&gt;]</translation>
    </message>
    <message>
        <source>expected ]</source>
        <translation>] انتظار می‌رفت</translation>
    </message>
    <message>
        <source>a parameter&apos;s name is made of letters, digits, _ and -</source>
        <translation>نام پارامتر از حرف، رقم، _ و - ساخته می‌شود</translation>
    </message>
    <message>
        <source>the parameter&apos;s name is too long (64 letters at most)</source>
        <translation>نام پارامتر بسیار دراز است (حداکثر 64 حرف)</translation>
    </message>
    <message>
        <source>the parameter&apos;s name needs a closing &gt;</source>
        <translation>نام پارامتر به &gt; پایانی نیاز دارد</translation>
    </message>
    <message>
        <source>the parameter&apos;s name is empty</source>
        <translation>نام پارامتر تهی است</translation>
    </message>
    <message>
        <source>#&lt;%1&gt; has no value yet</source>
        <translation>#&lt;%1&gt; هنوز مقداری ندارد</translation>
    </message>
    <message>
        <source>the text holds a NUL byte: this is not a G-code file</source>
        <translation>متن بایت NUL دارد: این پروندهٔ G-code نیست</translation>
    </message>
    <message>
        <source>%1 needs a speed S</source>
        <translation>%1 سرعت S می‌خواهد</translation>
    </message>
    <message>
        <source>the spindle&apos;s speed S cannot be below 0</source>
        <translation>سرعت اسپیندل S نمی‌تواند کمتر از 0 باشد</translation>
    </message>
    <message>
        <source>the idle time of M%1 S has no effect on this machine</source>
        <translation>زمان بیکاری M%1 S در این ماشین اثری ندارد</translation>
    </message>
    <message>
        <source>%1 takes S or R, not both</source>
        <translation>%1 یا S می‌گیرد یا R، نه هر دو</translation>
    </message>
    <message>
        <source>%1 needs a temperature S or R</source>
        <translation>%1 دمای S یا R می‌خواهد</translation>
    </message>
    <message>
        <source>%1 needs a temperature S</source>
        <translation>%1 دمای S می‌خواهد</translation>
    </message>
    <message>
        <source>a target temperature cannot be below 0 deg C</source>
        <translation>دمای هدف نمی‌تواند زیر 0 °C باشد</translation>
    </message>
    <message>
        <source>the fan&apos;s speed S is 0 to 255</source>
        <translation>سرعت فن S از 0 تا 255 است</translation>
    </message>
    <message>
        <source>a limit must be greater than 0</source>
        <translation>حد باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>%1 needs at least one axis word</source>
        <translation>%1 دست‌کم یک واژهٔ محور می‌خواهد</translation>
    </message>
    <message>
        <source>an acceleration must be greater than 0</source>
        <translation>شتاب باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>M205 (jerk, junction deviation) has no effect: corners are blended within the tolerance of G64 P</source>
        <translation>M205 (جرک، انحراف گوشه) اثری ندارد: گوشه‌ها در رواداری G64 P گرد می‌شوند</translation>
    </message>
    <message>
        <source>M206 is not supported: write G10 L2 P0 with the values of the other sign</source>
        <translation>M206 پشتیبانی نمی‌شود: G10 L2 P0 را با همان مقدارها و علامت وارونه بنویسید</translation>
    </message>
    <message>
        <source>M665 is not supported: write the geometry under [kinematics] in the machine file</source>
        <translation>M665 پشتیبانی نمی‌شود: هندسه را در پروندهٔ ماشین زیر [kinematics] بنویسید</translation>
    </message>
    <message>
        <source>M666 is not supported: write offset_mm of [joint.NAME.calibration] in the machine file</source>
        <translation>M666 پشتیبانی نمی‌شود: offset_mm را در پروندهٔ ماشین زیر [joint.NAME.calibration] بنویسید</translation>
    </message>
    <message>
        <source>M92 has no effect: mm_per_turn, full_steps_per_turn and microsteps of [joint.NAME] in the machine file say how far a step goes</source>
        <translation>M92 اثری ندارد: mm_per_turn، full_steps_per_turn و microsteps زیر [joint.NAME] در پروندهٔ ماشین می‌گویند که یک گام چقدر می‌رود</translation>
    </message>
    <message>
        <source>%1 has no effect: max_c of [heater.NAME] in the machine file says what a job may ask for</source>
        <translation>%1 اثری ندارد: max_c زیر [heater.NAME] در پروندهٔ ماشین می‌گوید که یک کار چه می‌تواند بخواهد</translation>
    </message>
    <message>
        <source>%1 has no effect: min_extrude_c of [thermal] in the machine file says below what nothing is fed</source>
        <translation>%1 اثری ندارد: min_extrude_c زیر [thermal] در پروندهٔ ماشین می‌گوید که زیر چه دمایی چیزی رانده نمی‌شود</translation>
    </message>
    <message>
        <source>%1 has no effect: sensor of [heater.NAME] in the machine file says what a heater is measured by</source>
        <translation>%1 اثری ندارد: sensor زیر [heater.NAME] در پروندهٔ ماشین می‌گوید که گرم‌کن با کدام حسگر اندازه‌گیری می‌شود</translation>
    </message>
    <message>
        <source>%1 has no effect: a heater&apos;s node measures its model: kinebus tune NAME, or M303</source>
        <translation>%1 اثری ندارد: مدل گرم‌کن را گره‌اش اندازه می‌گیرد: kinebus tune NAME یا M303</translation>
    </message>
    <message>
        <source>%1 has no effect: a heater&apos;s control belongs to its node and to [heater.NAME] in the machine file</source>
        <translation>%1 اثری ندارد: کنترل گرم‌کن کار گره‌اش و [heater.NAME] در پروندهٔ ماشین است</translation>
    </message>
    <message>
        <source>the machine has one tool, T0; where T1 and T2 turned axes, write A and C</source>
        <translation>ماشین یک ابزار دارد، T0؛ جایی که T1 و T2 محور می‌چرخاندند، A و C بنویسید</translation>
    </message>
    <message>
        <source>the retraction&apos;s length cannot be negative</source>
        <translation>درازای عقب‌کشی نمی‌تواند منفی باشد</translation>
    </message>
    <message>
        <source>F must be greater than 0</source>
        <translation>F باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>the retraction&apos;s lift cannot be negative</source>
        <translation>بالابری عقب‌کشی نمی‌تواند منفی باشد</translation>
    </message>
    <message>
        <source>%1 needs a percentage S</source>
        <translation>%1 درصد S می‌خواهد</translation>
    </message>
    <message>
        <source>the percentage of %1 is above 0 and at most 1000</source>
        <translation>درصد %1 بیش از 0 و حداکثر 1000 است</translation>
    </message>
    <message>
        <source>%1 needs the name of a stored job</source>
        <translation>%1 نام یک کار ذخیره‌شده را می‌خواهد</translation>
    </message>
    <message>
        <source>M26 needs a byte position S</source>
        <translation>M26 جای بایت S را می‌خواهد</translation>
    </message>
    <message>
        <source>the machine has no such tool: the last is T%1</source>
        <translation>ماشین چنین ابزاری ندارد: آخری T%1 است</translation>
    </message>
    <message>
        <source>G4 takes P or S, not both</source>
        <translation>G4 یا P می‌گیرد یا S، نه هر دو</translation>
    </message>
    <message>
        <source>G4 cannot wait for a negative time</source>
        <translation>G4 نمی‌تواند زمان منفی صبر کند</translation>
    </message>
    <message>
        <source>the tolerance P of G64 cannot be negative</source>
        <translation>رواداری P در G64 نمی‌تواند منفی باشد</translation>
    </message>
    <message>
        <source>the tolerance Q of G64 cannot be negative</source>
        <translation>رواداری Q در G64 نمی‌تواند منفی باشد</translation>
    </message>
    <message>
        <source>in a tilted plane A and C turn only under G43.4, or by G53.1</source>
        <translation>در صفحهٔ شیب‌دار A و C تنها زیر G43.4 یا با G53.1 می‌چرخند</translation>
    </message>
    <message>
        <source>in inverse time mode (G93) every G1, G2 and G3 needs F</source>
        <translation>در حالت زمان وارون (G93) هر G1 و G2 و G3 به F نیاز دارد</translation>
    </message>
    <message>
        <source>no feed rate is set: this move needs F</source>
        <translation>سرعت پیشروی داده نشده است: این حرکت F می‌خواهد</translation>
    </message>
    <message>
        <source>%1 and %2, or R</source>
        <translation>%1 و %2، یا R</translation>
    </message>
    <message>
        <source>%1 does not belong to the arc&apos;s plane: %2 needs %3</source>
        <translation>%1 از صفحهٔ کمان نیست: %2 به %3 نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs %2, not both</source>
        <translation>%1 به %2 نیاز دارد، نه هر دو</translation>
    </message>
    <message>
        <source>%1 needs %2</source>
        <translation>%1 به %2 نیاز دارد</translation>
    </message>
    <message>
        <source>with G90.1 an arc needs both %1 and %2</source>
        <translation>با G90.1 کمان هم %1 و هم %2 می‌خواهد</translation>
    </message>
    <message>
        <source>G53 needs G0 or G1, in this line or active</source>
        <translation>G53 به G0 یا G1 نیاز دارد، در همین خط یا فعال</translation>
    </message>
    <message>
        <source>G53 needs absolute distances (G90)</source>
        <translation>G53 فاصلهٔ مطلق (G90) می‌خواهد</translation>
    </message>
    <message>
        <source>%1 cannot change offsets in a tilted plane: end it with G69 first</source>
        <translation>%1 در صفحهٔ شیب‌دار مبدأ را عوض نمی‌کند: نخست با G69 پایانش دهید</translation>
    </message>
    <message>
        <source>G10 needs P: 1 for G54 ... 9 for G59.3, 0 for the active one</source>
        <translation>G10 به P نیاز دارد: 1 برای G54 ... 9 برای G59.3، 0 برای فعال</translation>
    </message>
    <message>
        <source>G92 needs at least one axis word</source>
        <translation>G92 دست‌کم یک واژهٔ محور می‌خواهد</translation>
    </message>
    <message>
        <source>G43.4 and G68.2 need a tool of length 0: the machine file says where the tool&apos;s tip is</source>
        <translation>G43.4 و G68.2 ابزاری با درازای 0 می‌خواهند: جای نوک ابزار در پروندهٔ ماشین است</translation>
    </message>
    <message>
        <source>a tilted plane is active already: end it with G69 first</source>
        <translation>صفحهٔ شیب‌دار فعال است: نخست با G69 پایانش دهید</translation>
    </message>
    <message>
        <source>G68.2 uses the line&apos;s axis words: write the motion in another line</source>
        <translation>G68.2 واژه‌های محور خط را به کار می‌برد: حرکت را در خط دیگری بنویسید</translation>
    </message>
    <message>
        <source>G53.1 needs a tilted plane (G68.2)</source>
        <translation>G53.1 صفحهٔ شیب‌دار (G68.2) می‌خواهد</translation>
    </message>
    <message>
        <source>no A within the machine&apos;s range makes the tool normal to the plane</source>
        <translation>در بازهٔ ماشین هیچ A ابزار را بر صفحه عمود نمی‌کند</translation>
    </message>
    <message>
        <source>G28 finds the home switches: name axes without a number</source>
        <translation>G28 کلیدهای خانه را می‌یابد: محورها را بی‌عدد نام ببرید</translation>
    </message>
    <message>
        <source>this gateway runs with its built-in machine: start it with --machine FILE</source>
        <translation>این درگاه با ماشین درون‌ساخت کار می‌کند: با --machine FILE آغازش کنید</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a %1 temperature (M104)</source>
        <translation>پیش از آنکه کار دمای %1 را بدهد (M104) فیلامنت رانده می‌شود</translation>
    </message>
    <message>
        <source>filament is fed with the %1 at %2; at least %3 is needed</source>
        <translation>فیلامنت با %1 در %2 رانده می‌شود؛ دست‌کم %3 لازم است</translation>
    </message>
    <message>
        <source>M112 stops the machine here</source>
        <translation>M112 ماشین را اینجا متوقف می‌کند</translation>
    </message>
    <message>
        <source>settings are kept in the machine file: M500 to M503 do nothing in a job</source>
        <translation>تنظیم‌ها در پروندهٔ ماشین‌اند: M500 تا M503 در کار اثری ندارند</translation>
    </message>
    <message>
        <source>hotend</source>
        <translation>نازل</translation>
    </message>
    <message>
        <source>bed</source>
        <translation>بستر</translation>
    </message>
    <message>
        <source>this machine has no %1 heater</source>
        <translation>این ماشین گرم‌کنِ %1 ندارد</translation>
    </message>
    <message>
        <source>%1 temperature %2; allowed are 0 to %3</source>
        <translation>دمای %1: %2؛ مجاز از 0 تا %3 است</translation>
    </message>
    <message>
        <source>%1 would wait forever: %2 is below the room&apos;s %3</source>
        <translation>%1 تا ابد صبر می‌کند: %2 زیر دمای اتاق %3 است</translation>
    </message>
    <message>
        <source>a job cannot manage stored jobs: M20 to M32 belong to a session</source>
        <translation>کار نمی‌تواند کارهای ذخیره‌شده را بگرداند: M20 تا M32 از آنِ نشست‌اند</translation>
    </message>
    <message>
        <source>shaped, this move asks %1 for %2 times its acceleration: lower the tool&apos;s acceleration, or take a shorter shaper</source>
        <translation>این حرکت پس از شکل‌دهی از %1 شتابی %2 برابر شتاب خودش می‌خواهد: شتاب ابزار را کم کنید یا شکل‌دهندهٔ کوتاه‌تری بگیرید</translation>
    </message>
    <message>
        <source>shaped, this move asks %1 for %2 times its speed: lower the tool&apos;s speed, or take a shorter shaper</source>
        <translation>این حرکت پس از شکل‌دهی از %1 سرعتی %2 برابر سرعت خودش می‌خواهد: سرعت ابزار را کم کنید یا شکل‌دهندهٔ کوتاه‌تری بگیرید</translation>
    </message>
    <message>
        <source>G28: %1</source>
        <translation>G28: %1</translation>
    </message>
    <message>
        <source>bed reference: %1</source>
        <translation>مرجع بستر: %1</translation>
    </message>
    <message>
        <source>stored jobs are managed by the session: M20 to M32 stand alone in a line</source>
        <translation>کارهای ذخیره‌شده را نشست می‌گرداند: M20 تا M32 در خط تنها می‌آیند</translation>
    </message>
    <message>
        <source>a move needs numbers</source>
        <translation>حرکت عدد می‌خواهد</translation>
    </message>
    <message>
        <source>the move is too long to be checked</source>
        <translation>حرکت درازتر از آن است که بررسی شود</translation>
    </message>
    <message>
        <source>centre, plane and target do not make an arc</source>
        <translation>مرکز، صفحه و هدف کمانی نمی‌سازند</translation>
    </message>
    <message>
        <source>the arc is too long to be checked</source>
        <translation>کمان درازتر از آن است که بررسی شود</translation>
    </message>
    <message>
        <source>the arc turns too far to be checked</source>
        <translation>کمان بیش از آن می‌چرخد که بررسی شود</translation>
    </message>
    <message>
        <source>filament is fed before a %1 temperature is set</source>
        <translation>پیش از تعیین دمای %1 فیلامنت رانده می‌شود</translation>
    </message>
    <message>
        <source>filament would be fed with the %1 at %2; at least %3 is needed</source>
        <translation>فیلامنت با %1 در %2 رانده می‌شد؛ دست‌کم %3 لازم است</translation>
    </message>
    <message>
        <source>this machine has no spindle</source>
        <translation>این ماشین اسپیندل ندارد</translation>
    </message>
    <message>
        <source>the spindle turns one way only: use M3</source>
        <translation>اسپیندل تنها یک سو می‌چرخد: M3 به کار ببرید</translation>
    </message>
    <message>
        <source>spindle speed %1 rpm; allowed are %2 to %3 rpm</source>
        <translation>سرعت اسپیندل %1 دور بر دقیقه؛ مجاز از %2 تا %3 است</translation>
    </message>
    <message>
        <source>no stored job has the name %1</source>
        <translation>کار ذخیره‌شده‌ای به نام %1 نیست</translation>
    </message>
    <message>
        <source>the disk is full</source>
        <translation>دیسک پر است</translation>
    </message>
    <message>
        <source>%1 cannot be written: %2</source>
        <translation>%1 نوشته نمی‌شود: %2</translation>
    </message>
    <message>
        <source>a job&apos;s name has 1 to 200 bytes</source>
        <translation>نام کار 1 تا 200 بایت است</translation>
    </message>
    <message>
        <source>a job&apos;s name does not begin with a dot</source>
        <translation>نام کار با نقطه آغاز نمی‌شود</translation>
    </message>
    <message>
        <source>a job&apos;s name has no slashes and no control characters</source>
        <translation>نام کار خط کج و نویسهٔ کنترلی ندارد</translation>
    </message>
    <message>
        <source>%1 cannot be written</source>
        <translation>%1 نوشته نمی‌شود</translation>
    </message>
    <message>
        <source>the job store&apos;s database: %1</source>
        <translation>پایگاه دادهٔ انبار کارها: %1</translation>
    </message>
    <message>
        <source>the job store&apos;s database cannot be opened</source>
        <translation>پایگاه دادهٔ انبار کارها باز نمی‌شود</translation>
    </message>
    <message>
        <source>this upload is not open: begin it again, it goes on where it was</source>
        <translation>این بارگذاری باز نیست: دوباره آغازش کنید، از همان جا ادامه می‌یابد</translation>
    </message>
    <message>
        <source>a job has at most %1 MiB</source>
        <translation>هر کار حداکثر %1 MiB است</translation>
    </message>
    <message>
        <source>the store&apos;s quota of %1 MiB has no room for this job: delete others first</source>
        <translation>سهمیهٔ %1 MiB انبار برای این کار جا ندارد: نخست کارهای دیگر را حذف کنید</translation>
    </message>
    <message>
        <source>the disk has no room for this job: delete others first</source>
        <translation>دیسک برای این کار جا ندارد: نخست کارهای دیگر را حذف کنید</translation>
    </message>
    <message>
        <source>an upload names the XXH3 of its job: 16 bytes</source>
        <translation>بارگذاری XXH3 کار را می‌گوید: 16 بایت</translation>
    </message>
    <message>
        <source>another job has the name %1 already</source>
        <translation>کار دیگری به نام %1 هست</translation>
    </message>
    <message>
        <source>the next byte of this upload is %1, not %2</source>
        <translation>بایت بعدی این بارگذاری %1 است، نه %2</translation>
    </message>
    <message>
        <source>more bytes than were announced</source>
        <translation>بایت‌ها بیش از اعلام‌شده‌اند</translation>
    </message>
    <message>
        <source>%1 bytes of the job have not come yet</source>
        <translation>%1 بایت از کار هنوز نیامده است</translation>
    </message>
    <message>
        <source>the bytes that came are not those that were announced (XXH3 differs): send the job again</source>
        <translation>بایت‌های رسیده همان اعلام‌شده‌ها نیستند (XXH3 فرق دارد): کار را دوباره بفرستید</translation>
    </message>
    <message>
        <source>a travel&apos;s minimum is above its maximum</source>
        <translation>کمینهٔ کورس از بیشینهٔ آن بالاتر است</translation>
    </message>
    <message>
        <source>the table&apos;s pivot is not a number</source>
        <translation>لولای میز عدد نیست</translation>
    </message>
    <message>
        <source>radius_mm must be above 0</source>
        <translation>radius_mm باید بالای 0 باشد</translation>
    </message>
    <message>
        <source>the arms must be longer than the delta radius</source>
        <translation>بازوها باید از شعاع دلتا درازتر باشند</translation>
    </message>
    <message>
        <source>a tower travel&apos;s minimum is above its maximum</source>
        <translation>کمینهٔ کورس برج از بیشینهٔ آن بالاتر است</translation>
    </message>
    <message>
        <source>a pose limit&apos;s minimum is above its maximum</source>
        <translation>کمینهٔ حد وضعیت از بیشینهٔ آن بالاتر است</translation>
    </message>
    <message>
        <source>the towers stand so that the delta is singular: two at one angle</source>
        <translation>برج‌ها چنان‌اند که دلتا تکین است: دو تا در یک زاویه</translation>
    </message>
    <message>
        <source>leg %1</source>
        <translation>پای %1</translation>
    </message>
    <message>
        <source>%1: a coordinate is not a number</source>
        <translation>%1: یک مختصه عدد نیست</translation>
    </message>
    <message>
        <source>%1: its length must be above 0 mm</source>
        <translation>%1: درازایش باید بالای 0 mm باشد</translation>
    </message>
    <message>
        <source>%1: its rail has no direction</source>
        <translation>%1: ریل آن جهت ندارد</translation>
    </message>
    <message>
        <source>%1: its connector offset is not a number</source>
        <translation>%1: جابه‌جایی اتصال آن عدد نیست</translation>
    </message>
    <message>
        <source>%1: its travel&apos;s minimum is above the maximum</source>
        <translation>%1: کمینهٔ کورس آن از بیشینه بالاتر است</translation>
    </message>
    <message>
        <source>rotation_scale_mm must be above 0</source>
        <translation>rotation_scale_mm باید بالای 0 باشد</translation>
    </message>
    <message>
        <source>max_condition must be 1 or more</source>
        <translation>max_condition باید 1 یا بیشتر باشد</translation>
    </message>
    <message>
        <source>no pose of the workspace can be reached: the legs are too short or the rails too far away</source>
        <translation>به هیچ وضعیتی از فضای کار نمی‌رسد: پاها کوتاه یا ریل‌ها دورند</translation>
    </message>
    <message>
        <source>the mechanism is singular or nearly so at every pose: the best condition number in the workspace is %1, the limit is %2; rails and attachments leave one motion of the platform without control (for instance attachments mirrored about the YZ plane)</source>
        <translation>سازوکار در هر وضعیت تکین یا نزدیک به آن است: بهترین عدد حالت در فضای کار %1 و حد %2 است؛ ریل‌ها و اتصال‌ها یک حرکت سکو را بی‌کنترل می‌گذارند (مانند اتصال‌های قرینه نسبت به صفحهٔ YZ)</translation>
    </message>
    <message>
        <source>rods, triangle, rails and rotation_scale_mm must be above 0 mm</source>
        <translation>میله‌ها، مثلث، ریل‌ها و rotation_scale_mm باید بالای 0 mm باشند</translation>
    </message>
    <message>
        <source>tool or table position is not a number</source>
        <translation>موقعیت ابزار یا میز عدد نیست</translation>
    </message>
    <message>
        <source>a travel&apos;s or limit&apos;s minimum is above its maximum</source>
        <translation>کمینهٔ یک کورس یا حد از بیشینهٔ آن بالاتر است</translation>
    </message>
    <message>
        <source>no pose of the workspace can be reached: the rods are too short for the rails&apos; distance</source>
        <translation>به هیچ وضعیتی از فضای کار نمی‌رسد: میله‌ها برای فاصلهٔ ریل‌ها کوتاه‌اند</translation>
    </message>
    <message>
        <source>the mechanism is singular or nearly so at every pose: the best condition number in the workspace is %1, the limit is %2; rods and triangle leave one motion of the spindle without control</source>
        <translation>سازوکار در هر وضعیت تکین یا نزدیک به آن است: بهترین عدد حالت در فضای کار %1 و حد %2 است؛ میله‌ها و مثلث یک حرکت اسپیندل را بی‌کنترل می‌گذارند</translation>
    </message>
    <message>
        <source>%1: out of reach, the leg is %2 too short</source>
        <translation>%1: دست‌نیافتنی، پا %2 کوتاه است</translation>
    </message>
    <message>
        <source>%1: would be %2 beyond its travel</source>
        <translation>%1: %2 از کورس خود بیرون می‌رود</translation>
    </message>
    <message>
        <source>%1: the leg leans %2 too far from its rail</source>
        <translation>%1: پا %2 بیش از اندازه از ریل کج می‌شود</translation>
    </message>
    <message>
        <source>%1: leg, rail and platform come %2 too near to each other</source>
        <translation>%1: پا و ریل و سکو %2 بیش از اندازه به هم نزدیک می‌شوند</translation>
    </message>
    <message>
        <source>%1 is %2 outside the workspace</source>
        <translation>%1 به اندازهٔ %2 بیرون از فضای کار است</translation>
    </message>
    <message>
        <source>too near to a singular pose: condition number %1</source>
        <translation>بسیار نزدیک به وضعیت تکین: عدد حالت %1</translation>
    </message>
    <message>
        <source>no pose fits these joint positions (%1 remain)</source>
        <translation>هیچ وضعیتی با این موقعیت مفصل‌ها جور نیست (%1 می‌ماند)</translation>
    </message>
    <message>
        <source>unknown pose error</source>
        <translation>خطای ناشناختهٔ وضعیت</translation>
    </message>
    <message>
        <source>machine</source>
        <translation>ماشین</translation>
    </message>
    <message>
        <source>joint %1</source>
        <translation>مفصل %1</translation>
    </message>
    <message>
        <source>over-current in a motor phase</source>
        <translation>جریان بیش از حد در یک فاز موتور</translation>
    </message>
    <message>
        <source>check the motor and its cable for a short, then clear</source>
        <translation>موتور و کابلش را برای اتصال کوتاه بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>a motor phase is shorted</source>
        <translation>یک فاز موتور اتصال کوتاه است</translation>
    </message>
    <message>
        <source>switch off, check the motor and its cable</source>
        <translation>خاموش کنید، موتور و کابلش را بررسی کنید</translation>
    </message>
    <message>
        <source>supply voltage too high</source>
        <translation>ولتاژ تغذیه بسیار بالاست</translation>
    </message>
    <message>
        <source>check the power supply</source>
        <translation>منبع تغذیه را بررسی کنید</translation>
    </message>
    <message>
        <source>supply voltage too low</source>
        <translation>ولتاژ تغذیه بسیار پایین است</translation>
    </message>
    <message>
        <source>check the power supply and its wiring</source>
        <translation>منبع تغذیه و سیم‌کشی آن را بررسی کنید</translation>
    </message>
    <message>
        <source>the node is too hot</source>
        <translation>گره بسیار داغ است</translation>
    </message>
    <message>
        <source>let it cool, check the fan</source>
        <translation>بگذارید خنک شود، فن را بررسی کنید</translation>
    </message>
    <message>
        <source>a motor driver is too hot</source>
        <translation>یک راه‌انداز موتور بسیار داغ است</translation>
    </message>
    <message>
        <source>let it cool, lower the current, check the fan</source>
        <translation>بگذارید خنک شود، جریان را کم کنید، فن را بررسی کنید</translation>
    </message>
    <message>
        <source>stored parameters are damaged</source>
        <translation>پارامترهای ذخیره‌شده خراب‌اند</translation>
    </message>
    <message>
        <source>bring up again: the gateway writes them anew</source>
        <translation>دوباره راه‌اندازی کنید: درگاه آن‌ها را از نو می‌نویسد</translation>
    </message>
    <message>
        <source>internal software fault</source>
        <translation>خطای درونی نرم‌افزار</translation>
    </message>
    <message>
        <source>switch the node off and on, report it</source>
        <translation>گره را خاموش و روشن کنید و گزارش دهید</translation>
    </message>
    <message>
        <source>encoder fault</source>
        <translation>نقص انکودر</translation>
    </message>
    <message>
        <source>check the encoder&apos;s cable</source>
        <translation>کابل انکودر را بررسی کنید</translation>
    </message>
    <message>
        <source>CAN frames were lost (overrun)</source>
        <translation>قاب‌های CAN گم شدند (سرریز)</translation>
    </message>
    <message>
        <source>check the load of the bus</source>
        <translation>بار گذرگاه را بررسی کنید</translation>
    </message>
    <message>
        <source>many CAN errors</source>
        <translation>خطاهای فراوان CAN</translation>
    </message>
    <message>
        <source>check cable and termination of the bus</source>
        <translation>کابل و پایان‌دهی گذرگاه را بررسی کنید</translation>
    </message>
    <message>
        <source>the gateway&apos;s heartbeat or SYNC was missed</source>
        <translation>ضربان درگاه یا SYNC نرسید</translation>
    </message>
    <message>
        <source>check the gateway and the bus, then clear</source>
        <translation>درگاه و گذرگاه را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>recovered from bus-off</source>
        <translation>از bus-off بازگشت</translation>
    </message>
    <message>
        <source>two nodes use the same id</source>
        <translation>دو گره یک شناسه دارند</translation>
    </message>
    <message>
        <source>give one of them another id (kinebus-node-id)</source>
        <translation>به یکی شناسهٔ دیگری بدهید (kinebus-node-id)</translation>
    </message>
    <message>
        <source>an expected PDO did not arrive</source>
        <translation>یک PDO مورد انتظار نرسید</translation>
    </message>
    <message>
        <source>following error: the motor did not follow</source>
        <translation>خطای پیروی: موتور پیروی نکرد</translation>
    </message>
    <message>
        <source>look for an obstacle, home again</source>
        <translation>به دنبال مانع بگردید، دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>a position limit was reached</source>
        <translation>به حد موقعیت رسید</translation>
    </message>
    <message>
        <source>check the machine file&apos;s limits, home again</source>
        <translation>حدهای پروندهٔ ماشین را بررسی کنید، دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>clock synchronisation was lost</source>
        <translation>همزمانی ساعت از دست رفت</translation>
    </message>
    <message>
        <source>check the bus, then clear</source>
        <translation>گذرگاه را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>general fault</source>
        <translation>نقص کلی</translation>
    </message>
    <message>
        <source>look at the node&apos;s state, then clear</source>
        <translation>وضعیت گره را ببینید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>current fault</source>
        <translation>نقص جریان</translation>
    </message>
    <message>
        <source>check motor and cable</source>
        <translation>موتور و کابل را بررسی کنید</translation>
    </message>
    <message>
        <source>voltage fault</source>
        <translation>نقص ولتاژ</translation>
    </message>
    <message>
        <source>temperature fault</source>
        <translation>نقص دما</translation>
    </message>
    <message>
        <source>let it cool</source>
        <translation>بگذارید خنک شود</translation>
    </message>
    <message>
        <source>hardware fault</source>
        <translation>نقص سخت‌افزار</translation>
    </message>
    <message>
        <source>switch the node off and on</source>
        <translation>گره را خاموش و روشن کنید</translation>
    </message>
    <message>
        <source>software fault</source>
        <translation>نقص نرم‌افزار</translation>
    </message>
    <message>
        <source>fault of an additional module</source>
        <translation>نقص پودمان افزوده</translation>
    </message>
    <message>
        <source>monitoring fault</source>
        <translation>نقص پایش</translation>
    </message>
    <message>
        <source>additional function fault</source>
        <translation>نقص کارکرد افزوده</translation>
    </message>
    <message>
        <source>its queue ran low</source>
        <translation>صف آن کم شد</translation>
    </message>
    <message>
        <source>clear and resume; when it comes again, check the load of gateway and bus</source>
        <translation>هشدار را رفع کنید و ادامه دهید؛ اگر باز پیش آمد بار درگاه و گذرگاه را بررسی کنید</translation>
    </message>
    <message>
        <source>a record was lost</source>
        <translation>یک رکورد گم شد</translation>
    </message>
    <message>
        <source>clear; when it comes again, check the bus for errors</source>
        <translation>هشدار را رفع کنید؛ اگر باز پیش آمد گذرگاه را برای خطا بررسی کنید</translation>
    </message>
    <message>
        <source>its position is not the gateway&apos;s</source>
        <translation>موقعیتش با درگاه یکی نیست</translation>
    </message>
    <message>
        <source>a record broke its limits</source>
        <translation>یک رکورد از حدهایش گذشت</translation>
    </message>
    <message>
        <source>clear; check the machine file against the node&apos;s limits</source>
        <translation>هشدار را رفع کنید؛ پروندهٔ ماشین را با حدهای گره بسنجید</translation>
    </message>
    <message>
        <source>the emergency stop input</source>
        <translation>ورودی توقف اضطراری</translation>
    </message>
    <message>
        <source>release the emergency stop when it is safe, then clear</source>
        <translation>هنگامی که امن است توقف اضطراری را رها کنید، سپس توقف را رفع کنید</translation>
    </message>
    <message>
        <source>a limit switch</source>
        <translation>یک کلید حد</translation>
    </message>
    <message>
        <source>move the carriage off the switch, then clear and home again</source>
        <translation>حامل را از کلید دور کنید، سپس هشدار را رفع کنید و دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>the gateway&apos;s heartbeat is missing</source>
        <translation>ضربان درگاه نیست</translation>
    </message>
    <message>
        <source>SYNC is missing</source>
        <translation>SYNC نیست</translation>
    </message>
    <message>
        <source>fault of a drive</source>
        <translation>نقص یک درایو</translation>
    </message>
    <message>
        <source>look at the drive&apos;s fault, then clear</source>
        <translation>نقص درایو را ببینید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>its drives were switched off in motion</source>
        <translation>درایوهایش در حرکت خاموش شدند</translation>
    </message>
    <message>
        <source>clear and enable again</source>
        <translation>هشدار را رفع کنید و دوباره روشن کنید</translation>
    </message>
    <message>
        <source>another node asked for it</source>
        <translation>گرهٔ دیگری خواسته است</translation>
    </message>
    <message>
        <source>look at the other node&apos;s message</source>
        <translation>پیام گرهٔ دیگر را ببینید</translation>
    </message>
    <message>
        <source>unknown fault</source>
        <translation>نقص ناشناخته</translation>
    </message>
    <message>
        <source>%1, axis B</source>
        <translation>%1، محور B</translation>
    </message>
    <message>
        <source>node %1: %2 (EMCY %3)</source>
        <translation>گره %1: %2 (EMCY %3)</translation>
    </message>
    <message>
        <source>check the node&apos;s power, its id (kinebus-node-id) and the bus cable, then bring up again</source>
        <translation>برق گره، شناسهٔ آن (kinebus-node-id) و کابل گذرگاه را بررسی کنید، سپس دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>connect the right node or update its firmware</source>
        <translation>گرهٔ درست را وصل کنید یا سفت‌افزارش را نو کنید</translation>
    </message>
    <message>
        <source>check the machine file against the node&apos;s limits</source>
        <translation>پروندهٔ ماشین را با حدهای گره بسنجید</translation>
    </message>
    <message>
        <source>look at the drive&apos;s fault, clear, then bring up again</source>
        <translation>نقص درایو را ببینید، هشدار را رفع کنید، سپس دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>switch one of the gateways off</source>
        <translation>یکی از درگاه‌ها را خاموش کنید</translation>
    </message>
    <message>
        <source>check the node&apos;s power and the bus cable, then clear and bring up again</source>
        <translation>برق گره و کابل گذرگاه را بررسی کنید، سپس هشدار را رفع کنید و دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>check the node&apos;s power, then clear, bring up and home again</source>
        <translation>برق گره را بررسی کنید، سپس هشدار را رفع کنید، راه‌اندازی و خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>check the bus for errors, then clear</source>
        <translation>گذرگاه را برای خطا بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>check switch and wiring, then clear and home again</source>
        <translation>کلید و سیم‌کشی را بررسی کنید، سپس هشدار را رفع کنید و دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>check the switches of the carriages that went on, then clear and home again</source>
        <translation>کلید حامل‌هایی را که رفتند بررسی کنید، سپس هشدار را رفع کنید و دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>check switches and home speeds, then clear and home again</source>
        <translation>کلیدها و سرعت خانه‌یابی را بررسی کنید، سپس هشدار را رفع کنید و دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>clear: positions are known, the job can be run again</source>
        <translation>هشدار را رفع کنید: موقعیت‌ها دانسته‌اند، کار را می‌توان دوباره اجرا کرد</translation>
    </message>
    <message>
        <source>clear; when it comes again, check the bus for lost frames</source>
        <translation>هشدار را رفع کنید؛ اگر باز پیش آمد گذرگاه را برای قاب‌های گم‌شده بررسی کنید</translation>
    </message>
    <message>
        <source>check cable and termination of the bus, then clear and bring up again</source>
        <translation>کابل و پایان‌دهی گذرگاه را بررسی کنید، سپس هشدار را رفع کنید و دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>check heater and sensor, then clear; a job that is held goes on by resume</source>
        <translation>گرم‌کن و حسگر را بررسی کنید، سپس هشدار را رفع کنید؛ کاری که مکث کرده است با ادامه دادن پیش می‌رود</translation>
    </message>
    <message>
        <source>correct the job, then clear</source>
        <translation>کار را درست کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>clear when the machine is safe</source>
        <translation>هنگامی که ماشین امن است توقف را رفع کنید</translation>
    </message>
    <message>
        <source>switch the machine off and on, home again</source>
        <translation>ماشین را خاموش و روشن کنید، دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>clear</source>
        <translation>رفع توقف</translation>
    </message>
    <message>
        <source>listening for another gateway</source>
        <translation>گوش به درگاه دیگر</translation>
    </message>
    <message>
        <source>looking for the nodes</source>
        <translation>جست‌وجوی گره‌ها</translation>
    </message>
    <message>
        <source>checking the nodes&apos; parameters</source>
        <translation>بررسی پارامترهای گره‌ها</translation>
    </message>
    <message>
        <source>starting the nodes</source>
        <translation>آغاز گره‌ها</translation>
    </message>
    <message>
        <source>synchronising the clocks</source>
        <translation>همزمانی ساعت‌ها</translation>
    </message>
    <message>
        <source>equalising path time</source>
        <translation>برابر کردن زمان مسیر</translation>
    </message>
    <message>
        <source>enabling the drives</source>
        <translation>روشن کردن درایوها</translation>
    </message>
    <message>
        <source>another gateway speaks on this bus (SYNC, stamps or heartbeat of node 127)</source>
        <translation>درگاه دیگری روی این گذرگاه سخن می‌گوید (SYNC، مُهر زمان یا ضربان گره 127)</translation>
    </message>
    <message>
        <source>vendor</source>
        <translation>سازنده</translation>
    </message>
    <message>
        <source>product</source>
        <translation>محصول</translation>
    </message>
    <message>
        <source>revision</source>
        <translation>ویرایش</translation>
    </message>
    <message>
        <source>serial number</source>
        <translation>شمارهٔ سریال</translation>
    </message>
    <message>
        <source>node %1: %2 is %3, the machine file wants %4</source>
        <translation>گره %1: %2 برابر %3 است، پروندهٔ ماشین %4 می‌خواهد</translation>
    </message>
    <message>
        <source>node %1 does not become operational</source>
        <translation>گره %1 آمادهٔ کار نمی‌شود</translation>
    </message>
    <message>
        <source>node %1 does not synchronise its clock</source>
        <translation>گره %1 ساعتش را همزمان نمی‌کند</translation>
    </message>
    <message>
        <source>the program of node %1 does not know smooth ramps: holds, resumes and changes of the override exceed the limits of jerk until it is updated</source>
        <translation>برنامهٔ گره %1 شیب‌های نرم را نمی‌شناسد: مکث، ازسرگیری و تغییر ضریب سرعت تا به‌روزرسانی آن از حدود جرک فراتر می‌روند</translation>
    </message>
    <message>
        <source>node %1 keeps its stop latched: an emergency stop or limit switch is active</source>
        <translation>گره %1 توقف را نگه می‌دارد: توقف اضطراری یا کلید حد فعال است</translation>
    </message>
    <message>
        <source>node %1: its drives do not enable (statuswords %2 and %3)</source>
        <translation>گره %1: درایوهایش روشن نمی‌شوند (واژه‌های وضعیت %2 و %3)</translation>
    </message>
    <message>
        <source>node %1 did not come back after the return to its default parameters</source>
        <translation>گره %1 پس از بازگشت به پارامترهای پیش‌فرض برنگشت</translation>
    </message>
    <message>
        <source>node %1: its parameters have the fingerprint %2, the machine file&apos;s have %3, after all were written</source>
        <translation>گره %1: اثرانگشت پارامترهایش %2 و از آنِ پروندهٔ ماشین %3 است، با آنکه همه نوشته شدند</translation>
    </message>
    <message>
        <source>there is no interrupted job to %1</source>
        <translation>کار قطع‌شده‌ای برای این نیست: %1</translation>
    </message>
    <message>
        <source>cannot %1 while the machine is %2</source>
        <translation>در وضعیت «%2» شدنی نیست: %1</translation>
    </message>
    <message>
        <source>%1: bring it up first</source>
        <translation>%1. نخست راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>%1: home it first</source>
        <translation>%1. نخست خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>%1: clear first</source>
        <translation>%1. نخست توقف را رفع کنید</translation>
    </message>
    <message>
        <source>no pose fits the joints&apos; positions: %1</source>
        <translation>هیچ وضعیتی با موقعیت مفصل‌ها جور نیست: %1</translation>
    </message>
    <message>
        <source>a jog needs numbers</source>
        <translation>حرکت دستی عدد می‌خواهد</translation>
    </message>
    <message>
        <source>a jog&apos;s speed is 0 or more</source>
        <translation>سرعت حرکت دستی 0 یا بیشتر است</translation>
    </message>
    <message>
        <source>a jog needs a distance</source>
        <translation>حرکت دستی فاصله می‌خواهد</translation>
    </message>
    <message>
        <source>it is set to %1 C and filament is to be fed: at least %2 C is needed</source>
        <translation>روی %1 °C تنظیم شده و فیلامنت باید رانده شود: دست‌کم %2 °C لازم است</translation>
    </message>
    <message>
        <source>it has only %1 C and filament is to be fed: at least %2 C is needed</source>
        <translation>تنها %1 °C است و فیلامنت باید رانده شود: دست‌کم %2 °C لازم است</translation>
    </message>
    <message>
        <source>the %1 was switched off: nothing waits for it</source>
        <translation>%1 خاموش شد: چیزی منتظر آن نمی‌ماند</translation>
    </message>
    <message>
        <source>the %1 is set to %2 C: set it to at least %3 C, then resume</source>
        <translation>%1 روی %2 °C تنظیم شده است: آن را دست‌کم روی %3 °C بگذارید، سپس ادامه دهید</translation>
    </message>
    <message>
        <source>the job feeds filament, which needs at least %1 C: hold it first</source>
        <translation>کار فیلامنت می‌راند و این دست‌کم %1 °C می‌خواهد: نخست آن را نگه دارید</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a %1 temperature (M104): it runs only while the %1 is set to at least %2</source>
        <translation>پیش از آنکه کار دمای %1 را بدهد (M104) فیلامنت رانده می‌شود: تنها وقتی اجرا می‌شود که %1 دست‌کم روی %2 تنظیم باشد</translation>
    </message>
    <message>
        <source>the %1 is too cold to feed filament: %2 C</source>
        <translation>%1 برای راندن فیلامنت بسیار سرد است: %2 °C</translation>
    </message>
    <message>
        <source>the job cannot be read twice: it is checked before it runs</source>
        <translation>کار را نمی‌توان دو بار خواند: پیش از اجرا بررسی می‌شود</translation>
    </message>
    <message>
        <source>cleared: resume brings the machine up again and goes on with the job</source>
        <translation>رفع شد: ادامه ماشین را دوباره راه می‌اندازد و کار را پی می‌گیرد</translation>
    </message>
    <message>
        <source>cleared: bring the machine up again</source>
        <translation>رفع شد: ماشین را دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>a feed override is 0.01 to 5</source>
        <translation>ضریب سرعت از 0.0۱ تا ۵ است</translation>
    </message>
    <message>
        <source>the temperature must be 0 to %1 C</source>
        <translation>دما باید از 0 تا %1 °C باشد</translation>
    </message>
    <message>
        <source>another gateway has begun to speak on this bus (COB-ID %1)</source>
        <translation>درگاه دیگری روی این گذرگاه به سخن آمده است (COB-ID %1)</translation>
    </message>
    <message>
        <source>node %1 stays stopped by NMT</source>
        <translation>گره %1 با NMT متوقف می‌ماند</translation>
    </message>
    <message>
        <source>%1 was taken out of operation by an NMT command of another device</source>
        <translation>دستور NMT دستگاهی دیگر %1 را از کار خارج کرد</translation>
    </message>
    <message>
        <source>%1: the drive of axis %2 was switched off by another device or a fault (statusword %3)</source>
        <translation>%1: دستگاهی دیگر یا یک خطا درایو محور %2 را خاموش کرد (statusword %3)</translation>
    </message>
    <message>
        <source>%1: axis %2 was set to the mode of operation %3 by another device</source>
        <translation>%1: دستگاهی دیگر حالت کار محور %2 را %3 کرد</translation>
    </message>
    <message>
        <source>%1: axis %2 moves, and not by this gateway</source>
        <translation>%1: محور %2 حرکت می‌کند، اما نه به خواست این درگاه</translation>
    </message>
    <message>
        <source>node %1: another device has changed its parameters (fingerprint %2, the machine file&apos;s is %3): bringing up again writes them anew</source>
        <translation>گره %1: دستگاهی دیگر پارامترهای آن را تغییر داده است (اثر انگشت %2، از آنِ پروندهٔ ماشین %3): راه‌اندازی دوباره آن‌ها را از نو می‌نویسد</translation>
    </message>
    <message>
        <source>node %1, which the machine file does not name, has asked all to stop</source>
        <translation>گره %1 که در پروندهٔ ماشین نیامده، از همه خواست بایستند</translation>
    </message>
    <message>
        <source>another device speaks LSS, which gives nodes their ids (COB-ID %1)</source>
        <translation>دستگاهی دیگر با LSS سخن می‌گوید که به گره‌ها شناسه می‌دهد (COB-ID %1)</translation>
    </message>
    <message>
        <source>another device fills the bus with frames that nobody here uses (COB-ID %1)</source>
        <translation>دستگاهی دیگر گذرگاه را با قاب‌هایی پر می‌کند که اینجا کسی به کار نمی‌برد (COB-ID %1)</translation>
    </message>
    <message>
        <source>another device sends remote frames (COB-ID %1): nobody answers them</source>
        <translation>دستگاهی دیگر قاب‌های درخواست (remote) می‌فرستد (COB-ID %1): کسی پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>another device has sent node %1 a record of motion (COB-ID %2)</source>
        <translation>دستگاهی دیگر به گره %1 یک رکورد حرکت فرستاده است (COB-ID %2)</translation>
    </message>
    <message>
        <source>another device has sent all nodes an NMT command (%1)</source>
        <translation>دستگاهی دیگر به همهٔ گره‌ها یک فرمان NMT فرستاده است (%1)</translation>
    </message>
    <message>
        <source>another device has sent node %1 an NMT command (%2)</source>
        <translation>دستگاهی دیگر به گره %1 یک فرمان NMT فرستاده است (%2)</translation>
    </message>
    <message>
        <source>another device has sent node %1 a controlword or set point (COB-ID %2)</source>
        <translation>دستگاهی دیگر به گره %1 کلمهٔ کنترل یا مقدار تنظیم فرستاده است (COB-ID %2)</translation>
    </message>
    <message>
        <source>another device writes object %2 of node %1 while the machine moves</source>
        <translation>هنگامی که ماشین حرکت می‌کند، دستگاهی دیگر در شیء %2 گره %1 می‌نویسد</translation>
    </message>
    <message>
        <source>Another device has changed a node</source>
        <translation>دستگاهی دیگر گره‌ای را تغییر داده است</translation>
    </message>
    <message>
        <source>look for another master or tool on the bus, then clear</source>
        <translation>به دنبال فرمانده یا ابزار دیگری روی گذرگاه بگردید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>clear: positions are read again; when it comes again, check the bus for errors</source>
        <translation>هشدار را رفع کنید: موقعیت‌ها دوباره خوانده می‌شوند؛ اگر باز پیش آمد گذرگاه را برای خطا بررسی کنید</translation>
    </message>
    <message>
        <source>node %1</source>
        <translation>گره %1</translation>
    </message>
    <message>
        <source>%1 has restarted</source>
        <translation>%1 از نو آغاز شد</translation>
    </message>
    <message>
        <source>%1 is silent</source>
        <translation>%1 پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>%1 has lost the synchronisation of its clock</source>
        <translation>%1 همزمانی ساعتش را از دست داد</translation>
    </message>
    <message>
        <source>%1 rests at another path time than the gateway: %2 us apart</source>
        <translation>%1 در زمان مسیری جز درگاه ایستاده است: %2 µs اختلاف</translation>
    </message>
    <message>
        <source>too late: the machine is in use already</source>
        <translation>دیر شده: ماشین در کار است</translation>
    </message>
    <message>
        <source>the interrupted job %1 is not there any more</source>
        <translation>کار قطع‌شدهٔ %1 دیگر نیست</translation>
    </message>
    <message>
        <source>the job %1 was interrupted: resume to go on with it, or cancel</source>
        <translation>کار %1 قطع شد: ادامه دهید یا لغو کنید</translation>
    </message>
    <message>
        <source>the nodes have lost their positions: resume homes the machine and goes on</source>
        <translation>گره‌ها موقعیتشان را از دست دادند: ادامه ماشین را خانه‌یابی می‌کند و پی می‌گیرد</translation>
    </message>
    <message>
        <source>the job does not go on: %1</source>
        <translation>کار پی گرفته نمی‌شود: %1</translation>
    </message>
    <message>
        <source>put right what is said, then resume</source>
        <translation>آنچه گفته شد درست کنید، سپس ادامه دهید</translation>
    </message>
    <message>
        <source>the job %1 is not the text that was interrupted: it does not go on</source>
        <translation>کار %1 همان متن قطع‌شده نیست: پی گرفته نمی‌شود</translation>
    </message>
    <message>
        <source>run it from its beginning</source>
        <translation>از آغاز اجرایش کنید</translation>
    </message>
    <message>
        <source>the interrupted job cannot be read</source>
        <translation>کار قطع‌شده خوانده نمی‌شود</translation>
    </message>
    <message>
        <source>the job&apos;s place cannot be reached: %1</source>
        <translation>به جای کار نمی‌توان رسید: %1</translation>
    </message>
    <message>
        <source>the tool was found %1 mm from its place: resume brings it back</source>
        <translation>ابزار %1 mm دور از جایش پیدا شد: ادامه آن را بازمی‌گرداند</translation>
    </message>
    <message>
        <source>the job %1 goes on</source>
        <translation>کار %1 ادامه می‌یابد</translation>
    </message>
    <message>
        <source>reading where the nodes stand</source>
        <translation>خواندن جای گره‌ها</translation>
    </message>
    <message>
        <source>path time did not come to rest</source>
        <translation>زمان مسیر نایستاد</translation>
    </message>
    <message>
        <source>a node keeps its stop latched: is an emergency stop or a limit switch still active?</source>
        <translation>گره‌ای توقف را نگه می‌دارد: آیا توقف اضطراری یا کلید حد هنوز فعال است؟</translation>
    </message>
    <message>
        <source>a drive does not enable again: its fault is still there</source>
        <translation>درایوی دوباره روشن نمی‌شود: نقصش هنوز هست</translation>
    </message>
    <message>
        <source>a node does not know its position after homing</source>
        <translation>گره‌ای پس از خانه‌یابی موقعیتش را نمی‌داند</translation>
    </message>
    <message>
        <source>homed</source>
        <translation>خانه‌یابی شد</translation>
    </message>
    <message>
        <source>cancelled: positions are known</source>
        <translation>لغو شد: موقعیت‌ها دانسته‌اند</translation>
    </message>
    <message>
        <source>the bus failed: %1</source>
        <translation>گذرگاه از کار افتاد: %1</translation>
    </message>
    <message>
        <source>error: %1</source>
        <translation>خطا: %1</translation>
    </message>
    <message>
        <source>warning: %1</source>
        <translation>اخطار: %1</translation>
    </message>
    <message>
        <source>the job was not begun: it has %1 errors</source>
        <translation>کار آغاز نشد: %1 خطا دارد</translation>
    </message>
    <message>
        <source>correct the lines named, then run it again</source>
        <translation>خط‌های گفته‌شده را درست کنید، سپس دوباره اجرا کنید</translation>
    </message>
    <message>
        <source>M112 in the job</source>
        <translation>M112 در کار</translation>
    </message>
    <message>
        <source>move done</source>
        <translation>حرکت انجام شد</translation>
    </message>
    <message>
        <source>all lines done: %1</source>
        <translation>همهٔ خط‌ها انجام شد: %1</translation>
    </message>
    <message>
        <source>job done: %1</source>
        <translation>کار تمام شد: %1</translation>
    </message>
    <message>
        <source>no file there</source>
        <translation>آنجا پرونده‌ای نیست</translation>
    </message>
    <message>
        <source>a readable TOML file</source>
        <translation>پروندهٔ TOML خواندنی</translation>
    </message>
    <message>
        <source>more than 1 MiB</source>
        <translation>بیش از 1 MiB</translation>
    </message>
    <message>
        <source>a machine file, which is a few KiB long</source>
        <translation>پروندهٔ ماشین که چند KiB است</translation>
    </message>
    <message>
        <source>a file that cannot be read</source>
        <translation>پرونده‌ای که خوانده نمی‌شود</translation>
    </message>
    <message>
        <source>a table</source>
        <translation>یک جدول</translation>
    </message>
    <message>
        <source>an array of %1</source>
        <translation>آرایه‌ای با %1 عضو</translation>
    </message>
    <message>
        <source>a text</source>
        <translation>یک متن</translation>
    </message>
    <message>
        <source>G-code, a line each; line %1: %2</source>
        <translation>G-code، هر فرمان در یک سطر؛ سطر %1: %2</translation>
    </message>
    <message>
        <source>another name than %1: upper and lower case are the same</source>
        <translation>نامی جز %1: حروف بزرگ و کوچک یکی هستند</translation>
    </message>
    <message>
        <source>true or false</source>
        <translation>true یا false</translation>
    </message>
    <message>
        <source>a number in %1</source>
        <translation>عددی در %1</translation>
    </message>
    <message>
        <source>at most %1 numbers, each in %2</source>
        <translation>حداکثر %1 عدد، هر یک در %2</translation>
    </message>
    <message>
        <source>a whole number in %1 .. %2</source>
        <translation>عددی درست در %1 .. %2</translation>
    </message>
    <message>
        <source>one of %1</source>
        <translation>یکی از %1</translation>
    </message>
    <message>
        <source>three numbers, each in %1</source>
        <translation>سه عدد، هر یک در %1</translation>
    </message>
    <message>
        <source>[least, most], least below most, in %1</source>
        <translation>[کمینه، بیشینه]، کمینه زیر بیشینه، در %1</translation>
    </message>
    <message>
        <source>a table, [%1]</source>
        <translation>یک جدول، [%1]</translation>
    </message>
    <message>
        <source>a node id in 1 .. 126</source>
        <translation>شناسهٔ گره در 1 .. 126</translation>
    </message>
    <message>
        <source>perhaps %1</source>
        <translation>شاید %1</translation>
    </message>
    <message>
        <source>a key that does not exist</source>
        <translation>کلیدی که وجود ندارد</translation>
    </message>
    <message>
        <source>a control character</source>
        <translation>نویسهٔ کنترلی</translation>
    </message>
    <message>
        <source>printable text, tabs and line ends</source>
        <translation>متن چاپ‌شدنی، جهش و پایان خط</translation>
    </message>
    <message>
        <source>no valid TOML: %1</source>
        <translation>TOML نادرست: %1</translation>
    </message>
    <message>
        <source>a machine that cannot work</source>
        <translation>ماشینی که کار نمی‌کند</translation>
    </message>
    <message>
        <source>a power of two</source>
        <translation>توانی از دو</translation>
    </message>
    <message>
        <source>at most run_current_ma, %1</source>
        <translation>حداکثر run_current_ma، %1</translation>
    </message>
    <message>
        <source>node %1 axis %2</source>
        <translation>گره %1 محور %2</translation>
    </message>
    <message>
        <source>a node&apos;s axis that no other joint has</source>
        <translation>محوری از گره که مفصل دیگری ندارد</translation>
    </message>
    <message>
        <source>at least acceleration + speed / stop ramp = %1, or a longer stop.ramp_ms</source>
        <translation>دست‌کم شتاب + سرعت / شیب توقف = %1، یا stop.ramp_ms درازتر</translation>
    </message>
    <message>
        <source>no frequency</source>
        <translation>بدون بسامد</translation>
    </message>
    <message>
        <source>the frequency of the vibration that the shaper is for</source>
        <translation>بسامد ارتعاشی که شکل‌دهنده برای آن است</translation>
    </message>
    <message>
        <source>pressure advance of %1 s; allowed are 0 to %2 s</source>
        <translation>پیش‌فشار %1 ثانیه؛ مجاز 0 تا %2 ثانیه است</translation>
    </message>
    <message>
        <source>pressure advance averaged over %1 s; allowed are 0 to %2 s</source>
        <translation>میانگین پیش‌فشار در %1 ثانیه؛ مجاز 0 تا %2 ثانیه است</translation>
    </message>
    <message>
        <source>no such key with a linear model</source>
        <translation>با مدل خطی چنین کلیدی نیست</translation>
    </message>
    <message>
        <source>the filament that this model presses together at most</source>
        <translation>فیلامنتی که این مدل حداکثر فشرده می‌کند</translation>
    </message>
    <message>
        <source>a deviation without a shaper</source>
        <translation>انحراف بدون شکل‌دهنده</translation>
    </message>
    <message>
        <source>a shaper: without one nothing is moved off its path</source>
        <translation>یک شکل‌دهنده: بدون آن چیزی از مسیرش جابه‌جا نمی‌شود</translation>
    </message>
    <message>
        <source>different shapers on a machine that turns or tilts the part</source>
        <translation>شکل‌دهنده‌های متفاوت در ماشینی که قطعه را می‌چرخاند یا کج می‌کند</translation>
    </message>
    <message>
        <source>one shaper for X, Y and Z, in [vibration] itself</source>
        <translation>یک شکل‌دهنده برای X، Y و Z، در خود [vibration]</translation>
    </message>
    <message>
        <source>no table</source>
        <translation>جدولی نیست</translation>
    </message>
    <message>
        <source>[%1homing]: a joint with limited travel must find its position</source>
        <translation>[%1homing]: مفصل با کورس محدود باید موقعیتش را بیابد</translation>
    </message>
    <message>
        <source>a scale on a joint that turns</source>
        <translation>خط‌کش روی مفصلی که می‌چرخد</translation>
    </message>
    <message>
        <source>a machine that can stand nowhere in its workspace: at its bed reference, %1: %2</source>
        <translation>ماشینی که در هیچ جای فضای کاری خود نمی‌تواند بایستد: در مرجع بستر، %1: %2</translation>
    </message>
    <message>
        <source>geometry, travel and workspace that fit each other</source>
        <translation>هندسه، کورس و فضای کاری که با هم بخوانند</translation>
    </message>
    <message>
        <source>a joint that moves along a rail</source>
        <translation>مفصلی که روی ریل حرکت می‌کند</translation>
    </message>
    <message>
        <source>a scale on a joint that does not home at a switch</source>
        <translation>خط‌کش روی مفصلی که با کلید به خانه نمی‌رود</translation>
    </message>
    <message>
        <source>[%1homing] with a method of 17..22: the switch&apos;s edge is where the scale begins</source>
        <translation>[%1homing] با روش 17..22: خط‌کش از لبهٔ کلید آغاز می‌شود</translation>
    </message>
    <message>
        <source>no pitch</source>
        <translation>گام (pitch) نیست</translation>
    </message>
    <message>
        <source>the pitch that the periodic error repeats with</source>
        <translation>گامی که خطای دوره‌ای با آن تکرار می‌شود</translation>
    </message>
    <message>
        <source>one number</source>
        <translation>یک عدد</translation>
    </message>
    <message>
        <source>two or more</source>
        <translation>دو یا بیشتر</translation>
    </message>
    <message>
        <source>the distance of the table&apos;s places, above 0</source>
        <translation>فاصلهٔ جاهای جدول، بالای 0</translation>
    </message>
    <message>
        <source>an error with a slope of %1</source>
        <translation>خطایی با شیب %1</translation>
    </message>
    <message>
        <source>at most %1</source>
        <translation>حداکثر %1</translation>
    </message>
    <message>
        <source>a correction that needs nearly all of the joint&apos;s speed or acceleration</source>
        <translation>تصحیحی که نزدیک به همهٔ سرعت یا شتاب مفصل را می‌خواهد</translation>
    </message>
    <message>
        <source>smaller errors, or higher limits of the joint</source>
        <translation>خطاهای کوچک‌تر یا حدهای بالاتر مفصل</translation>
    </message>
    <message>
        <source>17..22, 37, -3 or -4</source>
        <translation>17..22، 37، -3 یا -4</translation>
    </message>
    <message>
        <source>an input that is active when it is low</source>
        <translation>ورودی‌ای که در سطح پایین فعال است</translation>
    </message>
    <message>
        <source>active_low = false: DIAG of a driver is high when it tells a stop</source>
        <translation>active_low = false: پایه DIAG درایور هنگام اعلام توقفگاه در سطح بالا است</translation>
    </message>
    <message>
        <source>%1 on a node that drives the motor itself</source>
        <translation>%1 روی گره‌ای که خود موتور را می‌راند</translation>
    </message>
    <message>
        <source>a stepper driver that tells its load (TMC2209, TMC5160, TMC2130), and no [joint.%1.motor]; or a switch</source>
        <translation>درایور پله‌ای که بار را اعلام کند (TMC2209، TMC5160، TMC2130) و بدون [joint.%1.motor]؛ یا یک کلید</translation>
    </message>
    <message>
        <source>a load for a joint that does not home by it</source>
        <translation>بار برای مفصلی که با آن خانه‌یابی نمی‌کند</translation>
    </message>
    <message>
        <source>method = -3 or -4, or no stall_threshold</source>
        <translation>method = -3 یا -4، یا بدون stall_threshold</translation>
    </message>
    <message>
        <source>method = -3 or -4, or no stall_above</source>
        <translation>method = -3 یا -4، یا بدون stall_above</translation>
    </message>
    <message>
        <source>no stall_threshold</source>
        <translation>بدون stall_threshold</translation>
    </message>
    <message>
        <source>1 to 255: the load at which the driver says stop, 255 the lightest</source>
        <translation>1 تا 255: باری که درایور در آن توقفگاه اعلام می‌کند، 255 سبک‌ترین</translation>
    </message>
    <message>
        <source>at least %1, which is %2 full steps a second: slower, a driver does not see the load</source>
        <translation>دست‌کم %1، یعنی %2 گام کامل در ثانیه: کندتر از آن درایور بار را نمی‌بیند</translation>
    </message>
    <message>
        <source>as much as the fast speed, %1: both approaches by load are fast</source>
        <translation>برابر سرعت تند، %1: هر دو نزدیک‌شدن با بار تند است</translation>
    </message>
    <message>
        <source>%1 to %2: from %3 full steps a second to nine tenths of the fast speed</source>
        <translation>%1 تا %2: از %3 گام کامل در ثانیه تا نه‌دهم سرعت تند</translation>
    </message>
    <message>
        <source>at least %1, 2.5 times the way to the fast speed: a load on the first half of it is no stop</source>
        <translation>دست‌کم %1، 2.5 برابر راه تا سرعت تند: بار در نیمه نخست آن توقفگاه نیست</translation>
    </message>
    <message>
        <source>%1, which first goes off the stop and brings tool and table together by that</source>
        <translation>%1، که نخست از توقفگاه دور می‌شود و با آن ابزار و میز را به هم نزدیک می‌کند</translation>
    </message>
    <message>
        <source>a switch (17..22) for a joint whose homing takes tool and table apart</source>
        <translation>کلید (17..22) برای مفصلی که خانه‌یابی‌اش ابزار و میز را از هم دور می‌کند</translation>
    </message>
    <message>
        <source>%1 is to home by its driver&apos;s load, and the driver does not answer node %2: look at the motor supply and the jumpers in its socket, or home it at a switch</source>
        <translation>%1 باید با بار درایور خود خانه‌یابی کند و درایور به گره %2 پاسخ نمی‌دهد: تغذیه موتور و جامپرهای سوکت آن را ببینید، یا با کلید خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>%1 is to home by its driver&apos;s load, and node %2 has no driver there that tells it (TMC2209, TMC5160, TMC2130): home it at a switch, method 17 to 22</source>
        <translation>%1 باید با بار درایور خود خانه‌یابی کند و گره %2 آنجا درایوری ندارد که آن را اعلام کند (TMC2209، TMC5160، TMC2130): با کلید خانه‌یابی کنید، روش 17 تا 22</translation>
    </message>
    <message>
        <source>%1: its driver told a stop where there is none, or not twice at one place; stall_threshold is too high, the motion too rough, or DIAG is not led to the input</source>
        <translation>%1: درایور آن جایی که توقفگاهی نیست توقفگاه اعلام کرد، یا دو بار در یک جا اعلام نکرد؛ stall_threshold بیش از حد بالا، حرکت ناهموار، یا DIAG به ورودی وصل نیست</translation>
    </message>
    <message>
        <source>%1 came to no stop by its driver&apos;s load; stall_threshold is too low, or max_search too short</source>
        <translation>%1 با بار درایور خود به توقفگاهی نرسید؛ stall_threshold بیش از حد پایین یا max_search بیش از حد کوتاه است</translation>
    </message>
    <message>
        <source>at most the fast speed, %1</source>
        <translation>حداکثر سرعت تند، %1</translation>
    </message>
    <message>
        <source>at most the joint&apos;s speed, %1</source>
        <translation>حداکثر سرعت مفصل، %1</translation>
    </message>
    <message>
        <source>at most the joint&apos;s acceleration, %1</source>
        <translation>حداکثر شتاب مفصل، %1</translation>
    </message>
    <message>
        <source>within the joint&apos;s travel, %1 .. %2</source>
        <translation>در کورس مفصل، %1 .. %2</translation>
    </message>
    <message>
        <source>an input of node %1 that has the home function for axis %2</source>
        <translation>ورودی‌ای از گره %1 با کارکرد خانه برای محور %2</translation>
    </message>
    <message>
        <source>an input of node %1 that has the limit function for axis %2</source>
        <translation>ورودی‌ای از گره %1 با کارکرد حد برای محور %2</translation>
    </message>
    <message>
        <source>at most max_c of [heater.%1], %2</source>
        <translation>حداکثر max_c در [heater.%1]، یعنی %2</translation>
    </message>
    <message>
        <source>0, or a heater of this kind</source>
        <translation>0، یا گرم‌کنی از این نوع</translation>
    </message>
    <message>
        <source>an index that no other heater of the kind has: [heater.%1] has it</source>
        <translation>شماره‌ای که هیچ گرم‌کن دیگری از این نوع ندارد: [heater.%1] آن را دارد</translation>
    </message>
    <message>
        <source>an index that no other has: [%1] has it</source>
        <translation>شماره‌ای که دیگری ندارد: [%1] آن را دارد</translation>
    </message>
    <message>
        <source>a node that has such channels: %1 is 0</source>
        <translation>گره‌ای که چنین کانال‌هایی دارد: %1 برابر 0 است</translation>
    </message>
    <message>
        <source>a channel in 1 .. %1, as %2 says</source>
        <translation>کانالی در 1 .. %1، چنان‌که %2 می‌گوید</translation>
    </message>
    <message>
        <source>node %1 channel %2</source>
        <translation>گره %1 کانال %2</translation>
    </message>
    <message>
        <source>a channel that no other device has: [%1] has it</source>
        <translation>کانالی که هیچ دستگاه دیگری ندارد: [%1] آن را دارد</translation>
    </message>
    <message>
        <source>a function</source>
        <translation>یک کارکرد</translation>
    </message>
    <message>
        <source>an input that the node has: %1 is %2</source>
        <translation>ورودی‌ای که گره دارد: %1 برابر %2 است</translation>
    </message>
    <message>
        <source>a switch of an axis</source>
        <translation>کلید یک محور</translation>
    </message>
    <message>
        <source>none, emergency_stop or probe: this node has no axes</source>
        <translation>none، emergency_stop یا probe: این گره محور ندارد</translation>
    </message>
    <message>
        <source>a node that has axes: node.%1.axis_pairs is 0</source>
        <translation>گره‌ای که محور دارد: node.%1.axis_pairs برابر 0 است</translation>
    </message>
    <message>
        <source>an input of node %1 that has the probe function</source>
        <translation>ورودی‌ای از گره %1 با کارکرد پروب</translation>
    </message>
    <message>
        <source>no such key: a heater that is not there has no table</source>
        <translation>چنین کلیدی نیست: گرم‌کنی که نیست جدول ندارد</translation>
    </message>
    <message>
        <source>[heater.hotend] with kind = &quot;hotend&quot;, where = &quot;simulated&quot; and the same keys; a machine without hot end has no such table</source>
        <translation>[heater.hotend] با kind = &quot;hotend&quot;، where = &quot;simulated&quot; و همان کلیدها؛ ماشین بی‌نازل چنین جدولی ندارد</translation>
    </message>
    <message>
        <source>[heater.bed] with kind = &quot;bed&quot;, where = &quot;simulated&quot; and the same keys; a machine without heated bed has no such table</source>
        <translation>[heater.bed] با kind = &quot;bed&quot;، where = &quot;simulated&quot; و همان کلیدها؛ ماشین بی‌بستر گرم چنین جدولی ندارد</translation>
    </message>
    <message>
        <source>no such key: a machine without spindle has no table [spindle]</source>
        <translation>چنین کلیدی نیست: ماشین بی‌اسپیندل جدول [spindle] ندارد</translation>
    </message>
    <message>
        <source>no such key with the tool in the frame: the table&apos;s centre is the platform&apos;s zero</source>
        <translation>با ابزار در بدنه چنین کلیدی نیست: مرکز میز همان صفر سکو است</translation>
    </message>
    <message>
        <source>at most %1 tables with names of 1 .. %2 letters, digits, - and _</source>
        <translation>حداکثر %1 جدول با نام‌هایی از 1 .. %2 حرف، رقم، - و _</translation>
    </message>
    <message>
        <source>%1 is to live on node %2, where this gateway knows no such device: use where = &quot;simulated&quot;</source>
        <translation>%1 باید روی گره %2 باشد، ولی این درگاه آنجا چنین دستگاهی نمی‌شناسد: where = &quot;simulated&quot; بنویسید</translation>
    </message>
    <message>
        <source>M42 needs the output P and its value S</source>
        <translation>M42 خروجی P و مقدار آن S را می‌خواهد</translation>
    </message>
    <message>
        <source>an output&apos;s value S is 0 to 255</source>
        <translation>مقدار S یک خروجی از 0 تا 255 است</translation>
    </message>
    <message>
        <source>a job is under way: it chooses its tools</source>
        <translation>کاری در جریان است: ابزارهایش را خودش برمی‌گزیند</translation>
    </message>
    <message>
        <source>hotend T%1</source>
        <translation>نازل T%1</translation>
    </message>
    <message>
        <source>bed %1</source>
        <translation>بستر %1</translation>
    </message>
    <message>
        <source>chamber</source>
        <translation>محفظه</translation>
    </message>
    <message>
        <source>chamber %1</source>
        <translation>محفظه %1</translation>
    </message>
    <message>
        <source>a node that has axes: it tells when an input changes</source>
        <translation>گره‌ای با محور: همان است که تغییر ورودی را خبر می‌دهد</translation>
    </message>
    <message>
        <source>an input of node %1 whose function is none: a switch, a stop or a probe is not a job&apos;s to read</source>
        <translation>یک ورودی گرهٔ %1 که کارکرد آن none باشد: کلید، توقف و پروب را کار نمی‌خواند</translation>
    </message>
    <message>
        <source>M66 E reads an analogue input, which machines of this kind do not have: P reads a digital one</source>
        <translation>M66 E ورودی آنالوگ را می‌خواند که این گونه ماشین ندارد: P ورودی دیجیتال را می‌خواند</translation>
    </message>
    <message>
        <source>M66 needs the input P</source>
        <translation>M66 به ورودی P نیاز دارد</translation>
    </message>
    <message>
        <source>M66 L1 to L4 waits at most Q seconds: more than 0, at most %1</source>
        <translation>M66 L1 تا L4 دست بالا Q ثانیه منتظر می‌ماند: بیشتر از 0 و دست بالا %1</translation>
    </message>
    <message>
        <source>the job reads an input here: what follows is checked as if what it waits for came (M66 without L: as if the input were off), and again with what is read, just before it moves</source>
        <translation>کار این‌جا یک ورودی را می‌خواند: آنچه پس از آن است چنان بررسی می‌شود که گویی آنچه منتظرش است آمده (M66 بدون L: گویی ورودی خاموش است) و پیش از حرکت دوباره با آنچه خوانده شده</translation>
    </message>
    <message>
        <source>a macro or loop with M66 works in a job, not as a line: the lines behind M66 have to know what it reads</source>
        <translation>ماکرو یا حلقهٔ دارای M66 در یک کار کار می‌کند، نه به شکل یک خط: خط‌های پس از M66 باید بدانند چه خوانده است</translation>
    </message>
    <message>
        <source>this machine has no input %1: the machine file names inputs by [input.NAME]</source>
        <translation>این ماشین ورودی %1 ندارد: پروندهٔ ماشین ورودی‌ها را با [input.NAME] نام می‌برد</translation>
    </message>
    <message>
        <source>waiting for input %1</source>
        <translation>در انتظار ورودی %1</translation>
    </message>
    <message>
        <source>input %1 has not come in time: #5399 is -1</source>
        <translation>ورودی %1 به‌موقع نیامد: #5399 برابر -1 است</translation>
    </message>
    <message>
        <source>this machine has no output %1</source>
        <translation>این ماشین خروجی %1 ندارد</translation>
    </message>
    <message>
        <source>this machine has no fan %1: M106 has no effect</source>
        <translation>این ماشین فن %1 ندارد: M106 اثری ندارد</translation>
    </message>
    <message>
        <source>waiting for the %1 at %2</source>
        <translation>چشم به راه %1 در %2</translation>
    </message>
    <message>
        <source>this machine has no such heater</source>
        <translation>این ماشین چنین گرم‌کنی ندارد</translation>
    </message>
    <message>
        <source>a node that has its table, [node.%1]</source>
        <translation>گره‌ای که جدولش هست، [node.%1]</translation>
    </message>
    <message>
        <source>%1, which homes towards the nozzle</source>
        <translation>%1، که به سوی نازل خانه‌یابی می‌کند</translation>
    </message>
    <message>
        <source>homing away from the nozzle: method %1, with the switch at the rail&apos;s other end</source>
        <translation>خانه‌یابی به دور از نازل: روش %1، با کلید در سر دیگر ریل</translation>
    </message>
    <message>
        <source>an even number: ramps travel in 2 ms</source>
        <translation>عدد زوج: شیب‌ها با 2 ms می‌روند</translation>
    </message>
    <message>
        <source>at least stop.ramp_ms, %1</source>
        <translation>دست‌کم stop.ramp_ms، %1</translation>
    </message>
    <message>
        <source>at least two SYNC periods, %1</source>
        <translation>دست‌کم دو دورهٔ SYNC، %1</translation>
    </message>
    <message>
        <source>at least two heartbeats, %1</source>
        <translation>دست‌کم دو ضربان، %1</translation>
    </message>
    <message>
        <source>a network interface&apos;s name of 1 .. 15 characters</source>
        <translation>نام واسط شبکه با 1 .. 15 نویسه</translation>
    </message>
    <message>
        <source>at most the tool&apos;s speed, %1</source>
        <translation>حداکثر سرعت ابزار، %1</translation>
    </message>
    <message>
        <source>at most the largest speed, %1</source>
        <translation>حداکثر بزرگ‌ترین سرعت، %1</translation>
    </message>
    <message>
        <source>an empty name</source>
        <translation>نام تهی</translation>
    </message>
    <message>
        <source>a name</source>
        <translation>یک نام</translation>
    </message>
    <message>
        <source>an empty path</source>
        <translation>مسیر تهی</translation>
    </message>
    <message>
        <source>a directory</source>
        <translation>یک پوشه</translation>
    </message>
    <message>
        <source>the machine file&apos;s geometry cannot work: %1</source>
        <translation>هندسهٔ پروندهٔ ماشین کار نمی‌کند: %1</translation>
    </message>
    <message>
        <source>stop by command</source>
        <translation>ایست به فرمان</translation>
    </message>
    <message>
        <source>the drives do not change their mode of operation</source>
        <translation>درایوها حالت کارشان را عوض نمی‌کنند</translation>
    </message>
    <message>
        <source>%1: its drive is no longer enabled</source>
        <translation>%1: درایو آن دیگر روشن نیست</translation>
    </message>
    <message>
        <source>%1 did not find its home switch, or the switch did not release: is it wired to another carriage?</source>
        <translation>%1 کلید خانه را نیافت یا کلید رها نشد: آیا سیم آن به حامل دیگری می‌رود؟</translation>
    </message>
    <message>
        <source>homing took too long; not at home: %1</source>
        <translation>خانه‌یابی بیش از اندازه کشید؛ نرسیده‌ها: %1</translation>
    </message>
    <message>
        <source>%1 has gone %2 mm farther than another carriage; allowed are %3 mm</source>
        <translation>%1 به اندازهٔ %2 mm از حامل دیگر جلوتر رفت؛ مجاز %3 mm است</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>در حرکت</translation>
    </message>
    <message>
        <source>waiting for lines</source>
        <translation>چشم به راه خط‌ها</translation>
    </message>
    <message>
        <source>reading the job up to where it was</source>
        <translation>خواندن کار تا جای پیشین</translation>
    </message>
    <message>
        <source>interrupted</source>
        <translation>قطع شد</translation>
    </message>
    <message>
        <source>dwelling</source>
        <translation>درنگ</translation>
    </message>
    <message>
        <source>waiting for the spindle</source>
        <translation>چشم به راه اسپیندل</translation>
    </message>
    <message>
        <source>paused by the job</source>
        <translation>کار مکث کرده است</translation>
    </message>
    <message>
        <source>the job pauses here: resume to go on</source>
        <translation>کار اینجا مکث می‌کند: برای پی گرفتن ادامه دهید</translation>
    </message>
    <message>
        <source>M18/M84 in a job: the motors go on holding</source>
        <translation>M18/M84 در کار: موتورها همچنان نگه می‌دارند</translation>
    </message>
    <message>
        <source>node %1, object %2: no answer</source>
        <translation>گره %1، شیء %2: پاسخی نیست</translation>
    </message>
    <message>
        <source>node %1, object %2: %3</source>
        <translation>گره %1، شیء %2: %3</translation>
    </message>
    <message>
        <source>bring up</source>
        <translation>راه‌اندازی</translation>
    </message>
    <message>
        <source>home</source>
        <translation>خانه‌یابی</translation>
    </message>
    <message>
        <source>go to the bed reference</source>
        <translation>رفتن به مرجع بستر</translation>
    </message>
    <message>
        <source>jog</source>
        <translation>حرکت دستی</translation>
    </message>
    <message>
        <source>run a job</source>
        <translation>اجرای کار</translation>
    </message>
    <message>
        <source>hold</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>resume</source>
        <translation>ادامه</translation>
    </message>
    <message>
        <source>cancel</source>
        <translation>لغو</translation>
    </message>
    <message>
        <source>stop</source>
        <translation>ایست</translation>
    </message>
    <message>
        <source>set the feed override</source>
        <translation>تنظیم ضریب سرعت</translation>
    </message>
    <message>
        <source>switch the motors off</source>
        <translation>خاموش کردن موتورها</translation>
    </message>
    <message>
        <source>set a temperature</source>
        <translation>تنظیم دما</translation>
    </message>
    <message>
        <source>set the fan</source>
        <translation>تنظیم فن</translation>
    </message>
    <message>
        <source>set an output</source>
        <translation>تنظیم یک خروجی</translation>
    </message>
    <message>
        <source>an output&apos;s ratio is 0 to 1</source>
        <translation>نسبت یک خروجی ۰ تا ۱ است</translation>
    </message>
    <message>
        <source>turn the spindle</source>
        <translation>چرخاندن اسپیندل</translation>
    </message>
    <message>
        <source>set a work offset</source>
        <translation>تنظیم مبدأ کاری</translation>
    </message>
    <message>
        <source>off</source>
        <translation>خاموش</translation>
    </message>
    <message>
        <source>bring-up</source>
        <translation>راه‌اندازی</translation>
    </message>
    <message>
        <source>not homed</source>
        <translation>خانه‌یابی نشده</translation>
    </message>
    <message>
        <source>homing</source>
        <translation>در حال خانه‌یابی</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>آماده</translation>
    </message>
    <message>
        <source>checking the job</source>
        <translation>بررسی کار</translation>
    </message>
    <message>
        <source>running</source>
        <translation>در حال کار</translation>
    </message>
    <message>
        <source>holding</source>
        <translation>در حال مکث</translation>
    </message>
    <message>
        <source>held</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>cancelling</source>
        <translation>در حال لغو</translation>
    </message>
    <message>
        <source>stopping</source>
        <translation>در حال ایست</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>متوقف</translation>
    </message>
    <message>
        <source>alarm</source>
        <translation>هشدار</translation>
    </message>
    <message>
        <source>a temperature needs S</source>
        <translation>دما به S نیاز دارد</translation>
    </message>
    <message>
        <source>the lines&apos; host has gone: what is left of them is given up</source>
        <translation>میزبان خط‌ها رفته است: باقیماندهٔ خط‌ها رها شد</translation>
    </message>
    <message>
        <source>the heaters are off: %1</source>
        <translation>گرم‌کن‌ها خاموش شدند: %1</translation>
    </message>
    <message>
        <source>nothing has moved for %1 minutes</source>
        <translation>%1 دقیقه است که هیچ چیز حرکت نکرده است</translation>
    </message>
    <message>
        <source>the tool is not lifted as far as it should be: %1</source>
        <translation>ابزار به اندازهٔ لازم بالا برده نشد: %1</translation>
    </message>
    <message>
        <source>the job is held at X%1 Y%2 Z%3: mend what is wrong, then resume heats and goes on</source>
        <translation>کار در X%1 Y%2 Z%3 مکث کرده است: خرابی را برطرف کنید، سپس ادامه دهید؛ نخست گرم می‌کند و بعد پیش می‌رود</translation>
    </message>
    <message>
        <source>there is no filament any more</source>
        <translation>دیگر فیلامنتی نیست</translation>
    </message>
    <message>
        <source>the extruder turns and the filament stands still</source>
        <translation>اکسترودر می‌چرخد ولی فیلامنت ایستاده است</translation>
    </message>
    <message>
        <source>less filament comes than the extruder turns for</source>
        <translation>فیلامنت کمتر از چرخش اکسترودر می‌آید</translation>
    </message>
    <message>
        <source>at least %1, %2 edges</source>
        <translation>دست‌کم %1، یعنی %2 لبه</translation>
    </message>
    <message>
        <source>Filament does not come</source>
        <translation>فیلامنت نمی‌آید</translation>
    </message>
    <message>
        <source>put filament in, or free it on its way, then resume</source>
        <translation>فیلامنت را جا بزنید یا مسیرش را آزاد کنید، سپس ادامه دهید</translation>
    </message>
    <message>
        <source>the job was cancelled</source>
        <translation>کار لغو شد</translation>
    </message>
    <message>
        <source>at least %1 below limit_c, which is at most %2</source>
        <translation>دست‌کم %1 کمتر از limit_c، که حداکثر %2 است</translation>
    </message>
    <message>
        <source>at most max_c</source>
        <translation>حداکثر max_c</translation>
    </message>
    <message>
        <source>0 of a node that carries heat</source>
        <translation>برای گره‌ای که گرم‌کن دارد 0</translation>
    </message>
    <message>
        <source>at most %1 on a heat node</source>
        <translation>روی یک گرهٔ گرم‌کن حداکثر %1</translation>
    </message>
    <message>
        <source>at most %1 on a heat node, with those of the heaters</source>
        <translation>روی یک گرهٔ گرم‌کن، با آن‌های گرم‌کن‌ها، حداکثر %1</translation>
    </message>
    <message>
        <source>its node says that it is out of order</source>
        <translation>گره‌اش می‌گوید که خراب است</translation>
    </message>
    <message>
        <source>its node refuses %1 C: %2</source>
        <translation>گره‌اش %1 °C را نمی‌پذیرد: %2</translation>
    </message>
    <message>
        <source>its node has switched it off, and not by this gateway</source>
        <translation>گره‌اش آن را خاموش کرده است، و نه به خواست این درگاه</translation>
    </message>
    <message>
        <source>its node tells no temperatures any more</source>
        <translation>گره‌اش دیگر دمایی نمی‌گوید</translation>
    </message>
    <message>
        <source>node %1, which heats it, is not in operation: bring the machine up first</source>
        <translation>گره %1 که آن را گرم می‌کند در کار نیست: نخست ماشین را راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>M112 of the session</source>
        <translation>M112 از نشست</translation>
    </message>
    <message>
        <source>stop by the session</source>
        <translation>ایست از نشست</translation>
    </message>
    <message>
        <source>not a command of a session: %1; send motion as a job</source>
        <translation>فرمان نشست نیست: %1؛ حرکت را در یک کار بفرستید</translation>
    </message>
    <message>
        <source>line %1: the path leaves the machine&apos;s reach: %2</source>
        <translation>خط %1: مسیر از دسترس ماشین بیرون می‌رود: %2</translation>
    </message>
    <message>
        <source>line %1: the move&apos;s frame differs from the path&apos;s; the frame may only change by a position given at rest</source>
        <translation>خط %1: دستگاه حرکت با مسیر فرق دارد؛ تنها با موقعیتی که در سکون داده شود عوض می‌شود</translation>
    </message>
    <message>
        <source>line %1: a coordinate is not a number, or the feed is not greater than 0</source>
        <translation>خط %1: یک مختصه عدد نیست یا پیشروی بزرگ‌تر از 0 نیست</translation>
    </message>
    <message>
        <source>line %1: centre, normal, sweep and target do not make an arc</source>
        <translation>خط %1: مرکز، بردار عمود، زاویه و هدف کمانی نمی‌سازند</translation>
    </message>
    <message>
        <source>line %1: unknown error</source>
        <translation>خط %1: خطای ناشناخته</translation>
    </message>
    <message>
        <source>%1 has control of the machine</source>
        <translation>کنترل ماشین در دست %1 است</translation>
    </message>
    <message>
        <source>ask for it to be handed over, or take control by force</source>
        <translation>بخواهید واگذار شود، یا کنترل را به زور بگیرید</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>کنترل در دست %1 است</translation>
    </message>
    <message>
        <source>nobody has control</source>
        <translation>کنترل در دست کسی نیست</translation>
    </message>
    <message>
        <source>the gateway and the client speak different versions of the job link</source>
        <translation>درگاه و برنامه دو نسخهٔ جدا از پیوند کار را به کار می‌برند</translation>
    </message>
    <message>
        <source>version %1</source>
        <translation>نسخهٔ %1</translation>
    </message>
    <message>
        <source>the token is wrong</source>
        <translation>رمز نادرست است</translation>
    </message>
    <message>
        <source>the token that is set on the gateway</source>
        <translation>رمزی که روی درگاه تنظیم شده است</translation>
    </message>
    <message>
        <source>say hello first</source>
        <translation>نخست سلام (hello) بگویید</translation>
    </message>
    <message>
        <source>this gateway does not know the request</source>
        <translation>این درگاه این درخواست را نمی‌شناسد</translation>
    </message>
    <message>
        <source>the answer is longer than one message may be</source>
        <translation>پاسخ بلندتر از اندازهٔ مجاز یک پیام است</translation>
    </message>
    <message>
        <source>all places for clients are taken: only stop and questions about the state are answered</source>
        <translation>همهٔ جاهای کارخواه‌ها پر است: تنها به توقف و پرسش دربارهٔ وضعیت پاسخ داده می‌شود</translation>
    </message>
    <message>
        <source>the machine file is no text in UTF-8</source>
        <translation>پروندهٔ ماشین متنی به UTF-8 نیست</translation>
    </message>
    <message>
        <source>a job&apos;s name is text in UTF-8, without control characters and marks of direction</source>
        <translation>نام کار متنی به UTF-8 است، بی نویسه‌های کنترلی و نشانه‌های جهت</translation>
    </message>
    <message>
        <source>a client is sending this upload</source>
        <translation>کارخواهی در حال فرستادن این بارگذاری است</translation>
    </message>
    <message>
        <source>no upload of this name is half done</source>
        <translation>بارگذاری نیمه‌کاره‌ای به این نام نیست</translation>
    </message>
    <message>
        <source>this job is running</source>
        <translation>این کار در حال اجراست</translation>
    </message>
    <message>
        <source>%1 was started before: a job of its name runs once</source>
        <translation>%1 پیش‌تر آغاز شده است: کاری با چنین نامی یک بار اجرا می‌شود</translation>
    </message>
    <message>
        <source>nobody waits for it any more</source>
        <translation>دیگر کسی منتظر آن نیست</translation>
    </message>
    <message>
        <source>too many jobs are being checked: ask again later</source>
        <translation>کارهای زیادی بررسی می‌شوند: بعدتر دوباره بخواهید</translation>
    </message>
    <message>
        <source>a machine file has at most 512 KiB</source>
        <translation>پروندهٔ ماشین حداکثر 512 KiB است</translation>
    </message>
    <message>
        <source>the file was changed by somebody else: read it again</source>
        <translation>دیگری پرونده را عوض کرده است: دوباره بخوانید</translation>
    </message>
    <message>
        <source>control is handed over by the client that has it, to a client that is here</source>
        <translation>کنترل را کسی واگذار می‌کند که آن را دارد، به کسی که اینجاست</translation>
    </message>
    <message>
        <source>a fan&apos;s ratio is 0 to 1</source>
        <translation>نسبت فن از 0 تا 1 است</translation>
    </message>
    <message>
        <source>a work coordinate system is 1 (G54) to 9 (G59.3)</source>
        <translation>دستگاه مختصات کاری از 1 (G54) تا 9 (G59.3) است</translation>
    </message>
    <message>
        <source>a work offset needs numbers below 1000 m</source>
        <translation>مبدأ کاری عددهای کمتر از 1000 m می‌خواهد</translation>
    </message>
    <message>
        <source>the gateway ended while the job ran</source>
        <translation>درگاه هنگام اجرای کار پایان یافت</translation>
    </message>
    <message>
        <source>missing</source>
        <translation>نیست</translation>
    </message>
    <message>
        <source>found %1</source>
        <translation>یافته شد: %1</translation>
    </message>
    <message>
        <source>line %1: %2</source>
        <translation>خط %1: %2</translation>
    </message>
    <message>
        <source>the path leaves the machine&apos;s reach</source>
        <translation>مسیر از دسترس ماشین بیرون می‌رود</translation>
    </message>
    <message>
        <source>a phase came when none was asked for</source>
        <translation>مرحله‌ای بی‌درخواست رسید</translation>
    </message>
    <message>
        <source>the run does not start where the axis stands (counts apart)</source>
        <translation>حرکت از جای محور آغاز نمی‌شود (اختلاف شمارش)</translation>
    </message>
    <message>
        <source>the run must begin and end at rest (counts/s)</source>
        <translation>حرکت باید در سکون آغاز و پایان یابد (شمارش بر ثانیه)</translation>
    </message>
    <message>
        <source>the node lost a record (waits for record)</source>
        <translation>گره رکوردی را گم کرد (چشم به راه رکورد)</translation>
    </message>
    <message>
        <source>the node&apos;s state differs from the gateway&apos;s</source>
        <translation>وضعیت گره با درگاه یکی نیست</translation>
    </message>
    <message>
        <source>the node has taken a record otherwise than it was sent</source>
        <translation>گره رکوردی را جز آن‌گونه که فرستاده شد دریافت کرده است</translation>
    </message>
    <message>
        <source>the node ran out of records</source>
        <translation>رکوردهای گره تمام شد</translation>
    </message>
    <message>
        <source>the node expects a record that was never sent (record)</source>
        <translation>گره رکوردی را می‌خواهد که هرگز فرستاده نشد (رکورد)</translation>
    </message>
    <message>
        <source>records were sent but not accepted (ms)</source>
        <translation>رکوردها فرستاده شدند اما پذیرفته نشدند (ms)</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>ناشناخته</translation>
    </message>
    <message>
        <source>%1, node %2</source>
        <translation>%1، گره %2</translation>
    </message>
    <message>
        <source>%1 axis %2</source>
        <translation>%1 محور %2</translation>
    </message>
    <message>
        <source>%1, line %2</source>
        <translation>%1، خط %2</translation>
    </message>
    <message>
        <source>give one of them another id (kinebus-node-id) or take it off the bus, then clear and bring up again</source>
        <translation>به یکی شناسهٔ دیگری بدهید (kinebus-node-id) یا آن را از گذرگاه جدا کنید، سپس هشدار را رفع کنید و دوباره راه‌اندازی کنید</translation>
    </message>
    <message>
        <source>two nodes use the id %1: those with the serial numbers %2 and %3</source>
        <translation>دو گره شناسهٔ %1 را به کار می‌برند: با شماره‌های سریال %2 و %3</translation>
    </message>
    <message>
        <source>%1: go to the bed reference first</source>
        <translation>%1. نخست به مرجع بستر بروید</translation>
    </message>
    <message>
        <source>A node does not answer</source>
        <translation>یک گره پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>The wrong node is connected</source>
        <translation>گرهٔ نادرست وصل است</translation>
    </message>
    <message>
        <source>A node refuses its settings</source>
        <translation>یک گره تنظیماتش را نمی‌پذیرد</translation>
    </message>
    <message>
        <source>A drive does not switch on</source>
        <translation>یک درایو روشن نمی‌شود</translation>
    </message>
    <message>
        <source>There is a second gateway on the bus</source>
        <translation>درگاه دومی روی گذرگاه است</translation>
    </message>
    <message>
        <source>A node has gone silent</source>
        <translation>یک گره ساکت شده است</translation>
    </message>
    <message>
        <source>A node has restarted</source>
        <translation>یک گره دوباره راه افتاده است</translation>
    </message>
    <message>
        <source>The clocks have drifted apart</source>
        <translation>ساعت‌ها از هم دور شده‌اند</translation>
    </message>
    <message>
        <source>Homing has failed</source>
        <translation>خانه‌یابی ناموفق بود</translation>
    </message>
    <message>
        <source>The carriages are too far apart</source>
        <translation>حامل‌ها بیش از حد از هم دورند</translation>
    </message>
    <message>
        <source>Homing took too long</source>
        <translation>خانه‌یابی بیش از حد طول کشید</translation>
    </message>
    <message>
        <source>Motion was interrupted</source>
        <translation>حرکت قطع شد</translation>
    </message>
    <message>
        <source>The nodes disagree about the path</source>
        <translation>گره‌ها دربارهٔ مسیر هم‌نظر نیستند</translation>
    </message>
    <message>
        <source>The bus has failed</source>
        <translation>گذرگاه از کار افتاده است</translation>
    </message>
    <message>
        <source>A heater is too hot</source>
        <translation>یک گرم‌کن بسیار داغ است</translation>
    </message>
    <message>
        <source>a heater is above its limit</source>
        <translation>دمای یک گرم‌کن از حدش گذشته است</translation>
    </message>
    <message>
        <source>let it cool; check heater and sensor, then clear</source>
        <translation>بگذارید خنک شود؛ گرم‌کن و حسگر را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>A temperature sensor is open</source>
        <translation>مدار یک حسگر دما باز است</translation>
    </message>
    <message>
        <source>a temperature sensor or its wire is open</source>
        <translation>یک حسگر دما یا سیم آن قطع است</translation>
    </message>
    <message>
        <source>check the sensor, its plug and its wires, then clear</source>
        <translation>حسگر، دوشاخه و سیم‌هایش را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>A temperature sensor is shorted</source>
        <translation>یک حسگر دما اتصال کوتاه است</translation>
    </message>
    <message>
        <source>a temperature sensor is shorted</source>
        <translation>یک حسگر دما اتصال کوتاه است</translation>
    </message>
    <message>
        <source>A temperature sensor jumps</source>
        <translation>مقدار یک حسگر دما می‌پرد</translation>
    </message>
    <message>
        <source>a temperature changed faster than it can</source>
        <translation>دمایی تندتر از آنچه ممکن است تغییر کرد</translation>
    </message>
    <message>
        <source>A temperature sensor is silent</source>
        <translation>یک حسگر دما پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>a temperature is not measured any more</source>
        <translation>دمایی دیگر اندازه‌گیری نمی‌شود</translation>
    </message>
    <message>
        <source>A heater does not heat as it should</source>
        <translation>یک گرم‌کن آن‌گونه که باید گرم نمی‌کند</translation>
    </message>
    <message>
        <source>a heater&apos;s power does not arrive at its sensor</source>
        <translation>توان یک گرم‌کن به حسگرش نمی‌رسد</translation>
    </message>
    <message>
        <source>check that heater and sensor sit tight and are the right ones, then clear</source>
        <translation>بررسی کنید که گرم‌کن و حسگر محکم و از نوع درست باشند، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>A heater heats without being told to</source>
        <translation>یک گرم‌کن بدون فرمان گرم می‌کند</translation>
    </message>
    <message>
        <source>a heater&apos;s switch does not open: the contactor was opened</source>
        <translation>کلید یک گرم‌کن باز نمی‌شود: کنتاکتور قطع شد</translation>
    </message>
    <message>
        <source>switch off, let it cool, replace the heater&apos;s switch</source>
        <translation>خاموش کنید، بگذارید خنک شود، کلید گرم‌کن را عوض کنید</translation>
    </message>
    <message>
        <source>A fan stands still</source>
        <translation>یک فن ایستاده است</translation>
    </message>
    <message>
        <source>a fan does not turn</source>
        <translation>یک فن نمی‌چرخد</translation>
    </message>
    <message>
        <source>check the fan and its plug, then clear</source>
        <translation>فن و دوشاخه‌اش را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>A heater is not as it should be</source>
        <translation>وضعیت یک گرم‌کن درست نیست</translation>
    </message>
    <message>
        <source>The job went wrong</source>
        <translation>کار با خطا روبه‌رو شد</translation>
    </message>
    <message>
        <source>Stopped by the operator</source>
        <translation>به دست کاربر متوقف شد</translation>
    </message>
    <message>
        <source>The machine did not come to rest</source>
        <translation>ماشین از حرکت نایستاد</translation>
    </message>
    <message>
        <source>Too much current in a motor</source>
        <translation>جریان یک موتور بیش از حد است</translation>
    </message>
    <message>
        <source>The supply voltage is wrong</source>
        <translation>ولتاژ تغذیه نادرست است</translation>
    </message>
    <message>
        <source>A drive is too hot</source>
        <translation>یک درایو بیش از حد داغ است</translation>
    </message>
    <message>
        <source>Communication trouble on the bus</source>
        <translation>اشکال ارتباط روی گذرگاه</translation>
    </message>
    <message>
        <source>A node reports a fault</source>
        <translation>یک گره خطا گزارش می‌کند</translation>
    </message>
    <message>
        <source>Two nodes use the same id</source>
        <translation>دو گره یک شناسهٔ یکسان دارند</translation>
    </message>
    <message>
        <source>A motor phase is shorted</source>
        <translation>یک فاز موتور اتصال کوتاه است</translation>
    </message>
    <message>
        <source>A motor phase is open</source>
        <translation>یک فاز موتور قطع است</translation>
    </message>
    <message>
        <source>a motor phase carries no current</source>
        <translation>از یک فاز موتور جریان نمی‌گذرد</translation>
    </message>
    <message>
        <source>check the motor&apos;s plug and cable for a break, then clear</source>
        <translation>دوشاخه و کابل موتور را برای قطعی بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>The supply voltage is too high</source>
        <translation>ولتاژ تغذیه بسیار بالاست</translation>
    </message>
    <message>
        <source>The supply voltage is too low</source>
        <translation>ولتاژ تغذیه بسیار پایین است</translation>
    </message>
    <message>
        <source>A node is too hot</source>
        <translation>یک گره بسیار داغ است</translation>
    </message>
    <message>
        <source>A node&apos;s stored settings are damaged</source>
        <translation>تنظیمات ذخیره‌شدهٔ یک گره خراب است</translation>
    </message>
    <message>
        <source>A node&apos;s software has failed</source>
        <translation>نرم‌افزار یک گره خطا داد</translation>
    </message>
    <message>
        <source>An encoder has failed</source>
        <translation>یک انکودر از کار افتاد</translation>
    </message>
    <message>
        <source>A node has lost frames of the bus</source>
        <translation>یک گره قاب‌های گذرگاه را از دست داد</translation>
    </message>
    <message>
        <source>Many errors on the bus</source>
        <translation>خطاهای فراوان روی گذرگاه</translation>
    </message>
    <message>
        <source>A node does not hear the gateway</source>
        <translation>یک گره درگاه را نمی‌شنود</translation>
    </message>
    <message>
        <source>A node was off the bus</source>
        <translation>یک گره از گذرگاه جدا شده بود</translation>
    </message>
    <message>
        <source>A frame on the bus has a wrong value</source>
        <translation>یک قاب روی گذرگاه مقدار نادرستی دارد</translation>
    </message>
    <message>
        <source>a PDO had a value that is not allowed</source>
        <translation>یک PDO مقداری داشت که مجاز نیست</translation>
    </message>
    <message>
        <source>A frame on the bus has the wrong length</source>
        <translation>طول یک قاب روی گذرگاه نادرست است</translation>
    </message>
    <message>
        <source>a PDO was too short</source>
        <translation>یک PDO بیش از حد کوتاه بود</translation>
    </message>
    <message>
        <source>a PDO was too long</source>
        <translation>یک PDO بیش از حد بلند بود</translation>
    </message>
    <message>
        <source>a SYNC had the wrong length</source>
        <translation>طول یک SYNC نادرست بود</translation>
    </message>
    <message>
        <source>look for another master on the bus, update the node&apos;s firmware</source>
        <translation>به دنبال فرمانده دیگری روی گذرگاه بگردید، سفت‌افزار گره را نو کنید</translation>
    </message>
    <message>
        <source>A frame to a node did not come in time</source>
        <translation>قابی به یک گره به‌موقع نرسید</translation>
    </message>
    <message>
        <source>A motor does not follow</source>
        <translation>یک موتور پیروی نمی‌کند</translation>
    </message>
    <message>
        <source>A position limit was reached</source>
        <translation>به یک حد موقعیت رسید</translation>
    </message>
    <message>
        <source>A node has lost the common time</source>
        <translation>یک گره زمان مشترک را از دست داد</translation>
    </message>
    <message>
        <source>A node&apos;s queue ran low</source>
        <translation>صف یک گره کم شد</translation>
    </message>
    <message>
        <source>A motion record was lost</source>
        <translation>یک رکورد حرکت گم شد</translation>
    </message>
    <message>
        <source>A node is not where the gateway has sent it</source>
        <translation>یک گره در جایی که درگاه فرستاده نیست</translation>
    </message>
    <message>
        <source>A motion record broke a node&apos;s limits</source>
        <translation>یک رکورد حرکت از حدهای یک گره گذشت</translation>
    </message>
    <message>
        <source>Drives were switched off in motion</source>
        <translation>درایوها در حرکت خاموش شدند</translation>
    </message>
    <message>
        <source>Emergency stop</source>
        <translation>توقف اضطراری</translation>
    </message>
    <message>
        <source>A limit switch was reached</source>
        <translation>به یک کلید حد رسید</translation>
    </message>
    <message>
        <source>homing did not find the switch&apos;s edge</source>
        <translation>خانه‌یابی لبهٔ کلید را نیافت</translation>
    </message>
    <message>
        <source>this line taken out: every node speaks 1 Mbit/s, which is set on the interface (ip link set can0 type can bitrate 1000000)</source>
        <translation>برداشتن این سطر: هر گره با ۱ Mbit/s سخن می‌گوید و آن روی رابط تنظیم می‌شود (ip link set can0 type can bitrate 1000000)</translation>
    </message>
    <message>
        <source>A node&apos;s power stage does not work</source>
        <translation>طبقهٔ توان یک گره کار نمی‌کند</translation>
    </message>
    <message>
        <source>the power stage does not measure the motor&apos;s currents</source>
        <translation>طبقهٔ توان جریان‌های موتور را اندازه نمی‌گیرد</translation>
    </message>
    <message>
        <source>A node&apos;s program is for another board</source>
        <translation>برنامهٔ یک گره برای برد دیگری است</translation>
    </message>
    <message>
        <source>its program is for another board or chip: it drives nothing</source>
        <translation>برنامهٔ آن برای برد یا تراشهٔ دیگری است: چیزی را راه نمی‌اندازد</translation>
    </message>
    <message>
        <source>A board cannot measure its crystal</source>
        <translation>یک برد نمی‌تواند کریستال خود را اندازه بگیرد</translation>
    </message>
    <message>
        <source>the crystal was not measured: the board runs as with its own one</source>
        <translation>کریستال اندازه‌گیری نشد: برد مانند کریستال خودش کار می‌کند</translation>
    </message>
    <message>
        <source>check that the board is the one that the image is for</source>
        <translation>بررسی کنید که برد همان باشد که برنامه برای آن است</translation>
    </message>
    <message>
        <source>write the program for this board (kinebus-setup boards shows what it is)</source>
        <translation>برنامهٔ همین برد را بنویسید (kinebus-setup boards نشان می‌دهد کدام است)</translation>
    </message>
    <message>
        <source>A motor that a board does not have was switched on</source>
        <translation>موتوری که برد آن را ندارد روشن شد</translation>
    </message>
    <message>
        <source>this board has no motor driver for that axis</source>
        <translation>این برد برای آن محور درایور موتور ندارد</translation>
    </message>
    <message>
        <source>take the axis out of the machine file, or name the node that has it</source>
        <translation>محور را از پروندهٔ ماشین بردارید، یا گره‌ای را که آن را دارد بنویسید</translation>
    </message>
    <message>
        <source>switch the node off and on; when it comes again, replace the board</source>
        <translation>گره را خاموش و روشن کنید؛ اگر باز پیش آمد برد را عوض کنید</translation>
    </message>
    <message>
        <source>carriage %1</source>
        <translation>حامل %1</translation>
    </message>
    <message>
        <source>rail %1</source>
        <translation>ریل %1</translation>
    </message>
    <message>
        <source>platform</source>
        <translation>سکو</translation>
    </message>
    <message>
        <source>beam</source>
        <translation>تیر</translation>
    </message>
    <message>
        <source>table</source>
        <translation>میز</translation>
    </message>
    <message>
        <source>part on the table</source>
        <translation>قطعهٔ روی میز</translation>
    </message>
    <message>
        <source>tool</source>
        <translation>ابزار</translation>
    </message>
    <message>
        <source>nozzle</source>
        <translation>نازل</translation>
    </message>
    <message>
        <source>spindle</source>
        <translation>اسپیندل</translation>
    </message>
    <message>
        <source>nozzle holder</source>
        <translation>نگهدارندهٔ نازل</translation>
    </message>
    <message>
        <source>floor</source>
        <translation>کف</translation>
    </message>
    <message>
        <source>%1 and %2 would touch</source>
        <translation>%1 و %2 به هم می‌خورند</translation>
    </message>
    <message>
        <source>%1 and %2 would come as near as %3 mm; bodies keep %4 mm apart</source>
        <translation>%1 و %2 تا %3 mm به هم نزدیک می‌شوند؛ جسم‌ها %4 mm از هم فاصله دارند</translation>
    </message>
    <message>
        <source>above tool_radius_mm, %1: the tool&apos;s end is round</source>
        <translation>بیشتر از tool_radius_mm یعنی %1: نوک ابزار گرد است</translation>
    </message>
    <message>
        <source>part_radius_mm and part_height_mm both above 0, or neither of them</source>
        <translation>یا هر دوی part_radius_mm و part_height_mm بیشتر از ۰، یا هیچ‌کدام</translation>
    </message>
    <message>
        <source>%1 tables</source>
        <translation>%1 جدول</translation>
    </message>
    <message>
        <source>a box turned inside out</source>
        <translation>جعبه‌ای وارونه</translation>
    </message>
    <message>
        <source>each of its three numbers above that of from_mm</source>
        <translation>هر یک از سه عدد آن بیشتر از عدد from_mm</translation>
    </message>
    <message>
        <source>a rod without length</source>
        <translation>میله‌ای بدون طول</translation>
    </message>
    <message>
        <source>another point than from_mm</source>
        <translation>نقطه‌ای غیر از from_mm</translation>
    </message>
    <message>
        <source>bodies that touch: at %1, %2</source>
        <translation>جسم‌هایی که به هم می‌خورند: در %1، %2</translation>
    </message>
    <message>
        <source>a machine that has room somewhere: this is its best pose</source>
        <translation>ماشینی که جایی فضای کافی دارد: این بهترین وضعیت آن است</translation>
    </message>
    <message>
        <source>room at the bed reference, where the machine waits before a job</source>
        <translation>فضای کافی در مرجع بستر، جایی که ماشین پیش از کار منتظر می‌ماند</translation>
    </message>
    <message>
        <source>an order of some joints</source>
        <translation>ترتیب برای برخی مفصل‌ها</translation>
    </message>
    <message>
        <source>an order for every joint that homes, or for none: then it follows from the kinematics</source>
        <translation>ترتیب برای هر مفصلی که خانه‌یابی می‌کند یا برای هیچ‌کدام: آنگاه ترتیب از سینماتیک برمی‌آید</translation>
    </message>
    <message>
        <source>homing that is not safe: begun at %1, at %2 %3</source>
        <translation>خانه‌یابی ناامن: با آغاز در %1، در %2 %3</translation>
    </message>
    <message>
        <source>homing that is not safe: begun at %1, from %2 on the mechanism cannot follow</source>
        <translation>خانه‌یابی ناامن: با آغاز در %1، سازوکار از %2 به بعد نمی‌تواند دنبال کند</translation>
    </message>
    <message>
        <source>switches that can be reached from everywhere: see kinebus plan --home</source>
        <translation>کلیدهایی که از هر جا دست‌یافتنی باشند: kinebus plan --home را ببینید</translation>
    </message>
    <message>
        <source>a lower part than %1 mm: see kinebus plan --home</source>
        <translation>قطعه‌ای کوتاه‌تر از %1 mm: kinebus plan --home را ببینید</translation>
    </message>
    <message>
        <source>a joint that is led by its scale and has an error that is not linear</source>
        <translation>مفصلی که با خط‌کش خود تصحیح می‌شود و خطایش خطی نیست</translation>
    </message>
    <message>
        <source>correction_mm = 0, or scale and offset alone in the calibration</source>
        <translation>correction_mm = 0، یا در کالیبراسیون تنها scale و offset</translation>
    </message>
    <message>
        <source>the part becomes higher than the %1 mm that homing spares: it must be off the table before the machine homes with its positions unknown</source>
        <translation>قطعه از %1 mm که خانه‌یابی به آن نمی‌خورد بلندتر می‌شود: پیش از خانه‌یابی با موقعیت‌های نامعلوم باید از روی میز برداشته شود</translation>
    </message>
    <message>
        <source>the part of the interrupted job is %1 mm high and homing spares %2 mm: cancel the job and take the part off the table, then home</source>
        <translation>قطعهٔ کار قطع‌شده %1 mm بلندی دارد و خانه‌یابی تا %2 mm به قطعه نمی‌خورد: کار را لغو کنید، قطعه را از روی میز بردارید، سپس خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>the job was not begun: on the way to the bed reference %1</source>
        <translation>کار آغاز نشد: در راه مرجع بستر %1</translation>
    </message>
    <message>
        <source>move the tool clear by hand, then run it again</source>
        <translation>ابزار را دستی دور کنید، سپس دوباره اجرا کنید</translation>
    </message>
    <message>
        <source>an O word stands at the beginning of its line</source>
        <translation>واژهٔ O در آغاز سطر خود می‌ایستد</translation>
    </message>
    <message>
        <source>%1 turns with the spindle, which needs an encoder on it</source>
        <translation>%1 با اسپیندل می‌چرخد و به انکودر روی آن نیاز دارد</translation>
    </message>
    <message>
        <source>G76 means threading to some and fine boring to others; both need a spindle that follows an angle, which this machine does not have</source>
        <translation>G76 برای برخی پیچ‌تراشی و برای برخی داخل‌تراشی ظریف است؛ هر دو اسپیندلی می‌خواهند که زاویه را دنبال کند و این ماشین ندارد</translation>
    </message>
    <message>
        <source>G87 needs a spindle that stops at an angle, which this machine does not have</source>
        <translation>G87 اسپیندلی می‌خواهد که در زاویهٔ معین بایستد و این ماشین ندارد</translation>
    </message>
    <message>
        <source>G88 needs an operator who moves the axes by hand: use G82 or G86</source>
        <translation>G88 کاربری می‌خواهد که محورها را با دست حرکت دهد: G82 یا G86 به کار ببرید</translation>
    </message>
    <message>
        <source>A is taken for extrusion (E), as the slicer in the file&apos;s header writes it</source>
        <translation>A به جای اکستروژن (E) گرفته می‌شود، چنان که برش‌دهندهٔ سرآغاز پرونده می‌نویسد</translation>
    </message>
    <message>
        <source>%1 is not supported: write G10 L2 P0 with the values</source>
        <translation>%1 پشتیبانی نمی‌شود: G10 L2 P0 را با این مقدارها بنویسید</translation>
    </message>
    <message>
        <source>load the filament, then go on</source>
        <translation>فیلامنت را بگذارید و سپس ادامه دهید</translation>
    </message>
    <message>
        <source>%1 is unknown; a macro of the printer is written as [macro.%1] in the machine file</source>
        <translation>%1 ناشناخته است؛ ماکروی چاپگر در پروندهٔ ماشین به صورت [macro.%1] نوشته می‌شود</translation>
    </message>
    <message>
        <source>A is taken for extrusion (E), as slicers write it for %1</source>
        <translation>A به جای اکستروژن (E) گرفته می‌شود، چنان که برش‌دهنده‌ها برای %1 می‌نویسند</translation>
    </message>
    <message>
        <source>G10 needs L2 or L20 in this dialect (%1)</source>
        <translation>در این گویش (%1) G10 به L2 یا L20 نیاز دارد</translation>
    </message>
    <message>
        <source>the header names %1, which measures extrusion in mm^3: have the slicer write Marlin</source>
        <translation>سرآغاز %1 را نام می‌برد که اکستروژن را با mm^3 می‌سنجد: بگذارید برش‌دهنده برای Marlin بنویسد</translation>
    </message>
    <message>
        <source>the header names %1, and the text is read as that dialect</source>
        <translation>سرآغاز %1 را نام می‌برد و متن به آن گویش خوانده می‌شود</translation>
    </message>
    <message>
        <source>P of %1 is read as its value, as slicers write it for Mach3 and Machinekit</source>
        <translation>P در %1 مقدار آن گرفته می‌شود، چنان که برش‌دهنده‌ها برای Mach3 و Machinekit می‌نویسند</translation>
    </message>
    <message>
        <source>%1 needs the output E and its value Q</source>
        <translation>%1 خروجی E و مقدار Q را می‌خواهد</translation>
    </message>
    <message>
        <source>an output&apos;s value Q is 0 to 1</source>
        <translation>مقدار Q خروجی از 0 تا 1 است</translation>
    </message>
    <message>
        <source>the object %1 is left out</source>
        <translation>جسم %1 کنار گذاشته می‌شود</translation>
    </message>
    <message>
        <source>no object of the print is at work here</source>
        <translation>اینجا هیچ جسمی از چاپ در کار نیست</translation>
    </message>
    <message>
        <source>too many objects, or too long a name (1000 of 200 letters at most)</source>
        <translation>جسم‌ها بیش از اندازه‌اند یا نام بیش از اندازه بلند است (بیشینه 1000 جسم، 200 حرف)</translation>
    </message>
    <message>
        <source>%1 stands alone in its line</source>
        <translation>%1 در خط خود تنها می‌ایستد</translation>
    </message>
    <message>
        <source>M486 A needs a name in quotation marks</source>
        <translation>M486 A نامی در گیومه می‌خواهد</translation>
    </message>
    <message>
        <source>M486 takes S, P, U, T with a whole number, C and A&quot;name&quot;</source>
        <translation>M486 این‌ها را می‌گیرد: S، P، U، T با عدد درست، C و A&quot;نام&quot;</translation>
    </message>
    <message>
        <source>G43.4 and tilted planes cannot begin or end while an object is left out</source>
        <translation>تا جسمی کنار گذاشته است G43.4 و صفحهٔ شیب‌دار آغاز یا پایان نمی‌یابد</translation>
    </message>
    <message>
        <source>change the filament, then go on</source>
        <translation>فیلامنت را عوض کنید و سپس ادامه دهید</translation>
    </message>
    <message>
        <source>%1 needs %2, the bottom of the hole</source>
        <translation>%1 به %2، ته سوراخ، نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs R, where the feed begins</source>
        <translation>%1 به R، جای آغاز پیشروی، نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs Q, the depth of a peck</source>
        <translation>%1 به Q، عمق هر گام، نیاز دارد</translation>
    </message>
    <message>
        <source>the depth of a peck Q must be greater than 0</source>
        <translation>عمق هر گام Q باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>%1 has no place in a canned cycle</source>
        <translation>%1 در چرخهٔ آماده جایی ندارد</translation>
    </message>
    <message>
        <source>a canned cycle needs feed per minute (G94)</source>
        <translation>چرخهٔ آماده پیشروی بر دقیقه (G94) می‌خواهد</translation>
    </message>
    <message>
        <source>%1 needs the spindle to turn (%2)</source>
        <translation>برای %1 اسپیندل باید بچرخد (%2)</translation>
    </message>
    <message>
        <source>the tip of a lathe&apos;s tool (orientation %1) counts in the plane of G18 alone</source>
        <translation>نوک ابزار تراش (جهت %1) تنها در صفحهٔ G18 به حساب می‌آید</translation>
    </message>
    <message>
        <source>%1 needs a spindle of even speed: G97 first</source>
        <translation>%1 به اسپیندل با سرعت یکنواخت نیاز دارد: نخست G97</translation>
    </message>
    <message>
        <source>%1 needs K, the way of a turn</source>
        <translation>%1 به K، راه یک دور، نیاز دارد</translation>
    </message>
    <message>
        <source>the way of a turn K must be greater than 0</source>
        <translation>راه یک دور K باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>%1 has no place in a thread</source>
        <translation>%1 در رزوه جایی ندارد</translation>
    </message>
    <message>
        <source>%1 needs X, Y or Z, where the thread ends</source>
        <translation>%1 به X یا Y یا Z، جایی که رزوه پایان می‌یابد، نیاز دارد</translation>
    </message>
    <message>
        <source>G76 needs %1 as P Z I J K: pitch, end, crest, first cut, height of the thread</source>
        <translation>G76 به %1 نیاز دارد (P Z I J K): گام، پایان، سر دندانه، برش نخست، بلندی رزوه</translation>
    </message>
    <message>
        <source>%1 must be greater than 0</source>
        <translation>%1 باید بزرگ‌تر از 0 باشد</translation>
    </message>
    <message>
        <source>I of G76 says on which side the thread is: below 0 outside, above 0 inside</source>
        <translation>I در G76 می‌گوید رزوه در کدام سو است: زیر 0 بیرونی، بالای 0 درونی</translation>
    </message>
    <message>
        <source>R of G76 is at least 1</source>
        <translation>R در G76 دست‌کم 1 است</translation>
    </message>
    <message>
        <source>Q of G76 is 0 to %1 degrees</source>
        <translation>Q در G76 از 0 تا %1 درجه است</translation>
    </message>
    <message>
        <source>L of G76 needs E, how long a taper is</source>
        <translation>L در G76 به E، درازای شیب، نیاز دارد</translation>
    </message>
    <message>
        <source>the first cut J is far too small for this thread</source>
        <translation>برش نخست J برای این رزوه بسیار کوچک است</translation>
    </message>
    <message>
        <source>the thread of G76 has no length from here to Z</source>
        <translation>رزوهٔ G76 از اینجا تا Z درازایی ندارد</translation>
    </message>
    <message>
        <source>%1 turns back in the hole with the spindle, which needs an encoder on it and spindle.tap_rpm_per_s in the machine file; G84 and G74 are for a floating holder</source>
        <translation>%1 در سوراخ همراه اسپیندل برمی‌گردد و به انکودری روی اسپیندل و spindle.tap_rpm_per_s در پروندهٔ ماشین نیاز دارد؛ G84 و G74 برای نگهدارندهٔ شناور هستند</translation>
    </message>
    <message>
        <source>a thread belongs to a job: it cannot wait for lines</source>
        <translation>رزوه از آن یک کار است: نمی‌تواند چشم به راه خط‌ها بماند</translation>
    </message>
    <message>
        <source>the thread needs %1 at %2 rpm, a tenth more than S, and the plan reaches %3: a slower spindle, or more way before and behind the thread</source>
        <translation>رزوه در %2 دور بر دقیقه، یک‌دهم بیش از S، به %1 نیاز دارد و برنامه به %3 می‌رسد: اسپیندل کندتر، یا راه بیشتر پیش و پس از رزوه</translation>
    </message>
    <message>
        <source>the thread needs %1 at %2 rpm, a tenth more than S, and a limit slows the plan on the way: a slower spindle</source>
        <translation>رزوه در %2 دور بر دقیقه، یک‌دهم بیش از S، به %1 نیاز دارد و یک حد برنامه را در راه کند می‌کند: اسپیندل کندتر</translation>
    </message>
    <message>
        <source>the tool is in a thread: resume or cancel first</source>
        <translation>ابزار درون رزوه است: نخست ادامه دهید یا لغو کنید</translation>
    </message>
    <message>
        <source>taps need a spindle that is reversible and has encoder_counts</source>
        <translation>قلاویز به اسپیندلی نیاز دارد که reversible باشد و encoder_counts داشته باشد</translation>
    </message>
    <message>
        <source>the tool is in a tap: hold rests when it is out of the hole</source>
        <translation>ابزار در حال قلاویز است: نگه داشتن پس از بیرون آمدن از سوراخ می‌ایستد</translation>
    </message>
    <message>
        <source>the axes cannot turn back as fast as the spindle in a tap: a slower spindle, or a smaller spindle.tap_rpm_per_s</source>
        <translation>محورها در قلاویز به تندی اسپیندل برنمی‌گردند: اسپیندل کندتر، یا spindle.tap_rpm_per_s کوچک‌تر</translation>
    </message>
    <message>
        <source>the tap needs %1 to be as fast as the spindle and to turn back with it, and has %2: a slower spindle, a greater spindle.tap_rpm_per_s, or more way before the hole</source>
        <translation>قلاویز برای رسیدن به سرعت اسپیندل و برگشتن با آن به %1 نیاز دارد و %2 دارد: اسپیندل کندتر، spindle.tap_rpm_per_s بزرگ‌تر، یا راه بیشتر پیش از سوراخ</translation>
    </message>
    <message>
        <source>I of G33.1 is 1 at most: the way out is as fast as the way in</source>
        <translation>I در G33.1 حداکثر 1 است: راه بیرون به همان تندی راه درون است</translation>
    </message>
    <message>
        <source>the job ends: it was stopped in a thread, which has to be cut in one go</source>
        <translation>کار پایان می‌یابد: درون رزوه‌ای متوقف شد که باید یک‌باره تراشیده شود</translation>
    </message>
    <message>
        <source>the thread is lost: the tool is %1 turns from the spindle&apos;s angle; a spindle may be a tenth faster than S</source>
        <translation>رزوه از دست رفت: ابزار %1 دور از زاویهٔ اسپیندل دور است؛ اسپیندل می‌تواند تا یک‌دهم تندتر از S باشد</translation>
    </message>
    <message>
        <source>the bottom of the hole lies above R: %1 goes from R down</source>
        <translation>ته سوراخ بالای R است: %1 از R پایین می‌رود</translation>
    </message>
    <message>
        <source>the depth of a peck Q is far too small for this hole</source>
        <translation>عمق هر گام Q برای این سوراخ بسیار کوچک است</translation>
    </message>
    <message>
        <source>%1 cannot be below 0</source>
        <translation>%1 نمی‌تواند کمتر از ۰ باشد</translation>
    </message>
    <message>
        <source>the depth of a cut I must be greater than 0</source>
        <translation>عمق هر برش I باید بزرگ‌تر از ۰ باشد</translation>
    </message>
    <message>
        <source>%1 cannot stand in the profile of a cycle</source>
        <translation>%1 نمی‌تواند در نیم‌رخ یک چرخه بیاید</translation>
    </message>
    <message>
        <source>%1 works in the plane of G18, which is not tilted or turned</source>
        <translation>%1 در صفحهٔ G18 کار می‌کند که نه کج شده و نه چرخانده شده است</translation>
    </message>
    <message>
        <source>%1 cannot stand in an object that is left out</source>
        <translation>%1 نمی‌تواند در جسمی بیاید که کنار گذاشته شده است</translation>
    </message>
    <message>
        <source>%1 needs Q, the number of the subroutine that has the profile</source>
        <translation>%1 به Q نیاز دارد: شمارهٔ زیربرنامه‌ای که نیم‌رخ را دارد</translation>
    </message>
    <message>
        <source>the profile of a cycle lies in the plane of X and Z</source>
        <translation>نیم‌رخ یک چرخه در صفحهٔ X و Z است</translation>
    </message>
    <message>
        <source>A, C and E do not move in the profile of a cycle</source>
        <translation>‏A و C و E در نیم‌رخ یک چرخه حرکت نمی‌کنند</translation>
    </message>
    <message>
        <source>the profile of a cycle has %1 moves at most</source>
        <translation>نیم‌رخ یک چرخه حداکثر %1 حرکت دارد</translation>
    </message>
    <message>
        <source>only G0 to G3 can stand in the profile of a cycle</source>
        <translation>در نیم‌رخ یک چرخه فقط G0 تا G3 می‌تواند بیاید</translation>
    </message>
    <message>
        <source>the allowance D does not fit into this profile: an inside corner or arc is too narrow for it</source>
        <translation>اضافهٔ D در این نیم‌رخ جا نمی‌شود: یک گوشه یا کمان درونی برای آن تنگ است</translation>
    </message>
    <message>
        <source>the profile has no move behind the one that goes to it</source>
        <translation>نیم‌رخ پس از حرکتی که به آن می‌رسد حرکتی ندارد</translation>
    </message>
    <message>
        <source>the profile turns back along X: G72 cannot cut it</source>
        <translation>نیم‌رخ در راستای X برمی‌گردد: G72 نمی‌تواند آن را ببرد</translation>
    </message>
    <message>
        <source>the profile turns back along Z: G71 cannot cut it</source>
        <translation>نیم‌رخ در راستای Z برمی‌گردد: G71 نمی‌تواند آن را ببرد</translation>
    </message>
    <message>
        <source>the depth of a cut I is far too small for this profile</source>
        <translation>عمق هر برش I برای این نیم‌رخ بسیار کوچک است</translation>
    </message>
    <message>
        <source>G70 has too many passes P for this profile</source>
        <translation>‏G70 برای این نیم‌رخ گذرهای P بسیار زیادی دارد</translation>
    </message>
    <message>
        <source>a parameter&apos;s number must be a whole number from 1 to 5602</source>
        <translation>شمارهٔ پارامتر باید عددی صحیح از ۱ تا ۵602 باشد</translation>
    </message>
    <message>
        <source>there is no parameter #%1; they are #1 to #5602</source>
        <translation>پارامتر #%1 وجود ندارد؛ پارامترها از #1 تا #5602 هستند</translation>
    </message>
    <message>
        <source>M61 needs the tool Q</source>
        <translation>M61 به ابزار Q نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs the output P</source>
        <translation>%1 به خروجی P نیاز دارد</translation>
    </message>
    <message>
        <source>volumetric extrusion (M200 D) is not supported: use lengths of filament</source>
        <translation>اکستروژن حجمی (M200 D) پشتیبانی نمی‌شود: درازای فیلامنت به کار ببرید</translation>
    </message>
    <message>
        <source>M99 P is not supported: M99 goes back to the call</source>
        <translation>M99 P پشتیبانی نمی‌شود: M99 به فراخوانی بازمی‌گردد</translation>
    </message>
    <message>
        <source>there is no macro %1</source>
        <translation>ماکروی %1 وجود ندارد</translation>
    </message>
    <message>
        <source>M98 needs the program P</source>
        <translation>M98 به برنامهٔ P نیاز دارد</translation>
    </message>
    <message>
        <source>put in the tool T%1, then go on</source>
        <translation>ابزار T%1 را ببندید و سپس ادامه دهید</translation>
    </message>
    <message>
        <source>an O number has 9 digits at most</source>
        <translation>شمارهٔ O حداکثر 9 رقم دارد</translation>
    </message>
    <message>
        <source>the name of an O word needs a closing &gt;</source>
        <translation>نام واژهٔ O به &gt; پایانی نیاز دارد</translation>
    </message>
    <message>
        <source>the name of an O word is empty</source>
        <translation>نام واژهٔ O خالی است</translation>
    </message>
    <message>
        <source>the name of an O word is too long (64 letters at most)</source>
        <translation>نام واژهٔ O بسیار دراز است (حداکثر 64 حرف)</translation>
    </message>
    <message>
        <source>only a call may compute its O number</source>
        <translation>تنها فراخوانی می‌تواند شمارهٔ O را حساب کند</translation>
    </message>
    <message>
        <source>expected sub, call, if, while, do, repeat or another word of O after the label</source>
        <translation>پس از برچسب، sub، call، if، while، do، repeat یا واژهٔ دیگری از O انتظار می‌رود</translation>
    </message>
    <message>
        <source>G43.1 needs the tool&apos;s length Z, and a line without motion</source>
        <translation>G43.1 به درازای ابزار Z و سطری بی‌حرکت نیاز دارد</translation>
    </message>
    <message>
        <source>%1 uses the line&apos;s axis words: write the motion in another line</source>
        <translation>%1 واژه‌های محور سطر را به کار می‌برد: حرکت را در سطر دیگری بنویسید</translation>
    </message>
    <message>
        <source>G68 needs R, the angle in degrees</source>
        <translation>G68 به R، زاویه به درجه، نیاز دارد</translation>
    </message>
    <message>
        <source>G52 needs at least one axis word</source>
        <translation>G52 دست‌کم یک واژهٔ محور می‌خواهد</translation>
    </message>
    <message>
        <source>in the macro %1, line %2: %3</source>
        <translation>در ماکروی %1، سطر %2: %3</translation>
    </message>
    <message>
        <source>%1 (called in line %2)</source>
        <translation>%1 (فراخوانده در سطر %2)</translation>
    </message>
    <message>
        <source>%1 begins a program before the one above it has ended with M30</source>
        <translation>%1 برنامه‌ای آغاز می‌کند پیش از آن که برنامهٔ بالای آن با M30 پایان یابد</translation>
    </message>
    <message>
        <source>O words belong to a job: a single line can only call a macro</source>
        <translation>واژه‌های O از آنِ کارند: یک سطر تنها می‌تواند ماکرو فراخواند</translation>
    </message>
    <message>
        <source>what has to be kept since line %1 is too long (16 MB or a million lines)</source>
        <translation>آنچه از سطر %1 باید نگه داشته شود بسیار دراز است (16 MB یا یک میلیون سطر)</translation>
    </message>
    <message>
        <source>%1 has no beginning</source>
        <translation>%1 آغازی ندارد</translation>
    </message>
    <message>
        <source>%1 stands where %2 of line %3 is open</source>
        <translation>%1 جایی ایستاده که %2 سطر %3 باز است</translation>
    </message>
    <message>
        <source>%1 is defined already, in line %2</source>
        <translation>%1 پیش‌تر در سطر %2 تعریف شده است</translation>
    </message>
    <message>
        <source>O words are nested too deep (%1 levels at most)</source>
        <translation>واژه‌های O بسیار تودرتو هستند (حداکثر %1 لایه)</translation>
    </message>
    <message>
        <source>%1 is in no loop of this label</source>
        <translation>%1 در حلقه‌ای با این برچسب نیست</translation>
    </message>
    <message>
        <source>%1 has no end</source>
        <translation>%1 پایانی ندارد</translation>
    </message>
    <message>
        <source>the program %1 has no M99 at its end</source>
        <translation>برنامهٔ %1 در پایان M99 ندارد</translation>
    </message>
    <message>
        <source>loops and calls carry out more than %1 lines: one of them does not end</source>
        <translation>حلقه‌ها و فراخوانی‌ها بیش از %1 سطر اجرا می‌کنند: یکی از آن‌ها پایان نمی‌یابد</translation>
    </message>
    <message>
        <source>%1 stands in no subroutine</source>
        <translation>%1 در زیربرنامه نیست</translation>
    </message>
    <message>
        <source>calls are nested too deep (%1 levels at most)</source>
        <translation>فراخوانی‌ها بسیار تودرتو هستند (حداکثر %1 لایه)</translation>
    </message>
    <message>
        <source>the arguments of a call stand in [ ]</source>
        <translation>آرگومان‌های فراخوانی در [ ] می‌ایستند</translation>
    </message>
    <message>
        <source>a call has 30 arguments at most</source>
        <translation>فراخوانی حداکثر 30 آرگومان دارد</translation>
    </message>
    <message>
        <source>%1 is not defined above this call</source>
        <translation>%1 بالای این فراخوانی تعریف نشده است</translation>
    </message>
    <message>
        <source>M99 ends a subprogram: a main program that begins again for ever is not run</source>
        <translation>M99 زیربرنامه را پایان می‌دهد: برنامهٔ اصلی‌ای که همواره از نو آغاز شود اجرا نمی‌شود</translation>
    </message>
    <message>
        <source>M98 P belongs to a job: a single line can only call a macro</source>
        <translation>M98 P از آنِ کار است: یک سطر تنها می‌تواند ماکرو فراخواند</translation>
    </message>
    <message>
        <source>there is no program O%1 in this text</source>
        <translation>در این متن برنامهٔ O%1 نیست</translation>
    </message>
    <message>
        <source>%1 needs the plane XY (G17)</source>
        <translation>%1 به صفحهٔ XY (G17) نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs feed per minute (G94)</source>
        <translation>%1 پیشروی بر دقیقه (G94) می‌خواهد</translation>
    </message>
    <message>
        <source>%1 has no place in a spline</source>
        <translation>%1 در اسپلاین جایی ندارد</translation>
    </message>
    <message>
        <source>%1 needs I and J</source>
        <translation>%1 به I و J نیاز دارد</translation>
    </message>
    <message>
        <source>%1 needs P and Q</source>
        <translation>%1 به P و Q نیاز دارد</translation>
    </message>
    <message>
        <source>%1 ends a NURBS, and none has begun</source>
        <translation>%1 یک NURBS را پایان می‌دهد، ولی هیچ‌کدام آغاز نشده است</translation>
    </message>
    <message>
        <source>%1 needs its order P</source>
        <translation>%1 به مرتبه‌ی خود P نیاز دارد</translation>
    </message>
    <message>
        <source>%1 stands in a line of its own</source>
        <translation>%1 در سطری جداگانه می‌آید</translation>
    </message>
    <message>
        <source>P without X Y Z is the weight of the first control point</source>
        <translation>P بدون X Y Z وزن نخستین نقطه‌ی کنترل است</translation>
    </message>
    <message>
        <source>a NURBS has %1 control points at most</source>
        <translation>یک NURBS حداکثر %1 نقطه‌ی کنترل دارد</translation>
    </message>
    <message>
        <source>a NURBS of order %1 needs as many points, and has %2</source>
        <translation>یک NURBS از مرتبه‌ی %1 به همان تعداد نقطه نیاز دارد و %2 نقطه دارد</translation>
    </message>
    <message>
        <source>a line with K alone came before: no more points can follow</source>
        <translation>پیش از این سطری تنها با K آمد: نقطه‌ی دیگری نمی‌تواند بیاید</translation>
    </message>
    <message>
        <source>each line of G6.2 needs its knot K</source>
        <translation>هر سطر G6.2 به گره‌ی خود K نیاز دارد</translation>
    </message>
    <message>
        <source>the NURBS that G5.2 began has no end: write G5.3 before this line</source>
        <translation>NURBS آغازشده با G5.2 پایان ندارد: پیش از این سطر G5.3 بنویسید</translation>
    </message>
    <message>
        <source>the NURBS that G6.2 began has no end: as many lines with K alone as its order P come behind its points</source>
        <translation>NURBS آغازشده با G6.2 پایان ندارد: پس از نقطه‌هایش به تعداد مرتبه‌ی P سطرهایی تنها با K می‌آید</translation>
    </message>
    <message>
        <source>the first control point of G6.2 must be where the tool stands</source>
        <translation>نخستین نقطه‌ی کنترل G6.2 باید جایی باشد که ابزار ایستاده است</translation>
    </message>
    <message>
        <source>the knots K have to begin and end with as many equal ones as the order P, and to have fewer equal ones between</source>
        <translation>گره‌های K باید با تعداد برابر مرتبه‌ی P از مقدارهای یکسان آغاز و پایان یابند و در میان کمتر از آن یکسان باشند</translation>
    </message>
    <message>
        <source>the knots K of a NURBS cannot fall</source>
        <translation>گره‌های K یک NURBS نمی‌توانند کاهش یابند</translation>
    </message>
    <message>
        <source>the line begins with no code and is passed over: %1</source>
        <translation>سطر با کدی آغاز نمی‌شود و نادیده گرفته می‌شود: %1</translation>
    </message>
    <message>
        <source>the weight %1 of a control point is 0.000001 to 1000000</source>
        <translation>وزن %1 یک نقطه‌ی کنترل از 0.000001 تا 1000000 است</translation>
    </message>
    <message>
        <source>there is no %1 in this text</source>
        <translation>در این متن %1 وجود ندارد</translation>
    </message>
    <message>
        <source>G-code, a line each</source>
        <translation>جی‌کد، هر سطر یکی</translation>
    </message>
    <message>
        <source>a folder that cannot be read</source>
        <translation>پوشه‌ای که خوانده نمی‌شود</translation>
    </message>
    <message>
        <source>a name of 1 .. %1 letters, digits, -, . and _</source>
        <translation>نامی از 1 تا %1 حرف، رقم، -، . و _</translation>
    </message>
    <message>
        <source>macros, a file each</source>
        <translation>ماکروها، هر کدام یک فایل</translation>
    </message>
    <message>
        <source>more than %1 files</source>
        <translation>بیش از %1 فایل</translation>
    </message>
    <message>
        <source>more than 1 MiB of macros</source>
        <translation>بیش از 1 MiB ماکرو</translation>
    </message>
    <message>
        <source>no modal state is kept here: M70 or M73 keeps it, M71 forgets it</source>
        <translation>در اینجا وضعیت مودالی نگه داشته نشده است: M70 یا M73 آن را نگه می‌دارد و M71 فراموش می‌کند</translation>
    </message>
    <message>
        <source>with G95 the spindle&apos;s speed S comes before F</source>
        <translation>با G95 سرعت اسپیندل S پیش از F می‌آید</translation>
    </message>
    <message>
        <source>the spline is too large</source>
        <translation>اسپلاین بسیار بزرگ است</translation>
    </message>
    <message>
        <source>another jog is under way</source>
        <translation>حرکت دستی دیگری در جریان است</translation>
    </message>
    <message>
        <source>%1 moves are waiting already</source>
        <translation>%1 حرکت هم‌اکنون در صف است</translation>
    </message>
    <message>
        <source>it was busy itself</source>
        <translation>خودش مشغول بود</translation>
    </message>
    <message>
        <source>it waited for the disk (%1 pages)</source>
        <translation>منتظر دیسک بود (%1 صفحه)</translation>
    </message>
    <message>
        <source>other programs had the processor</source>
        <translation>پردازنده در اختیار برنامه‌های دیگر بود</translation>
    </message>
    <message>
        <source>it was stopped, or the computer was</source>
        <translation>متوقف شده بود، یا رایانه متوقف بود</translation>
    </message>
    <message>
        <source>%1; it has no real-time priority</source>
        <translation>%1؛ اولویت بی‌درنگ ندارد</translation>
    </message>
    <message>
        <source>the gateway is back: the job goes on by itself</source>
        <translation>درگاه بازگشت: کار خودبه‌خود ادامه می‌یابد</translation>
    </message>
    <message>
        <source>the gateway did not run for %1 s: %2</source>
        <translation>درگاه %1 ثانیه اجرا نشد: %2</translation>
    </message>
    <message>
        <source>the gateway was away %1 times: the job waits for a person</source>
        <translation>درگاه %1 بار غایب بود: کار منتظر یک نفر است</translation>
    </message>
    <message>
        <source>run_current_ma, %1, to 5000</source>
        <translation>run_current_ma، %1، تا 5000</translation>
    </message>
    <message>
        <source>%1 has no effect in a job: run_current_ma and hold_current_ma of [joint.NAME] in the machine file say what a motor gets; M906 on the console or of a print host sets it</source>
        <translation>%1 در یک کار اثری ندارد: run_current_ma و hold_current_ma در [joint.NAME] پروندهٔ ماشین می‌گویند موتور چه می‌گیرد؛ M906 از کنسول یا از برنامهٔ چاپ آن را تنظیم می‌کند</translation>
    </message>
    <message>
        <source>set a motor&apos;s currents</source>
        <translation>تنظیم جریان‌های یک موتور</translation>
    </message>
    <message>
        <source>measure a motor</source>
        <translation>اندازه‌گیری یک موتور</translation>
    </message>
    <message>
        <source>cannot %1 while a motor is measured (%2)</source>
        <translation>هنگام اندازه‌گیری یک موتور (%2) ممکن نیست: %1</translation>
    </message>
    <message>
        <source>there is no joint %1: they are 1 to %2</source>
        <translation>مفصل %1 وجود ندارد: شماره‌ها از 1 تا %2 هستند</translation>
    </message>
    <message>
        <source>one motor alone goes at most 20 mm or 30 degrees: the others hold the tool</source>
        <translation>یک موتور به‌تنهایی حداکثر 20 mm یا 30 درجه می‌رود: بقیه ابزار را نگه می‌دارند</translation>
    </message>
    <message>
        <source>%1 cannot move alone here</source>
        <translation>%1 اینجا نمی‌تواند به‌تنهایی حرکت کند</translation>
    </message>
    <message>
        <source>it is simulated: only a heater on a heat node can be measured</source>
        <translation>شبیه‌سازی‌شده است: تنها گرم‌کنی که روی یک گرهٔ گرم‌کن باشد اندازه‌گیری می‌شود</translation>
    </message>
    <message>
        <source>it was ended before it was done</source>
        <translation>پیش از پایان کار متوقف شد</translation>
    </message>
    <message>
        <source>its node was not in operation any more: measure it again</source>
        <translation>گره آن دیگر در کار نبود: دوباره اندازه بگیرید</translation>
    </message>
    <message>
        <source>the way to the temperature is too short to measure anything: let it cool first</source>
        <translation>راه تا آن دما برای اندازه‌گیری بسیار کوتاه است: نخست بگذارید خنک شود</translation>
    </message>
    <message>
        <source>full power does not warm its sensor: look whether heater and sensor are plugged in, and in their places</source>
        <translation>توان کامل حسگرش را گرم نمی‌کند: ببینید گرم‌کن و حسگر وصل و در جای خود باشند</translation>
    </message>
    <message>
        <source>it was not half the way up after 20 minutes: choose a lower temperature, or look at its supply and its power</source>
        <translation>پس از 20 دقیقه به نیمهٔ راه نرسید: دمای پایین‌تری برگزینید یا تغذیه و توان آن را ببینید</translation>
    </message>
    <message>
        <source>it would have gone above its limit: choose a lower temperature</source>
        <translation>از حد خود بالاتر می‌رفت: دمای پایین‌تری برگزینید</translation>
    </message>
    <message>
        <source>its curve is not that of a heater: look for a loose heater or sensor, a fan or a draught, then measure again</source>
        <translation>منحنی آن از آنِ یک گرم‌کن نیست: گرم‌کن یا حسگر شل، فن یا جریان هوا را بجویید و دوباره اندازه بگیرید</translation>
    </message>
    <message>
        <source>its node gives no reason</source>
        <translation>گره آن دلیلی نمی‌گوید</translation>
    </message>
    <message>
        <source>its node refuses to measure it: %1</source>
        <translation>گره آن اندازه‌گیری را نمی‌پذیرد: %1</translation>
    </message>
    <message>
        <source>its node has ended it: see its alarms, or measure it again</source>
        <translation>گره آن را پایان داد: هشدارهایش را ببینید یا دوباره اندازه بگیرید</translation>
    </message>
    <message>
        <source>its node did not store it, and forgets it without power: %1</source>
        <translation>گره آن را ذخیره نکرد و بی برق فراموش می‌کند: %1</translation>
    </message>
    <message>
        <source>its node does not answer: %1</source>
        <translation>گره آن پاسخ نمی‌دهد: %1</translation>
    </message>
    <message>
        <source>M303 measures a heater, which no job does: write it on the console or send it from a print host while nothing runs</source>
        <translation>M303 یک گرم‌کن را اندازه می‌گیرد و هیچ کاری چنین نمی‌کند: وقتی چیزی اجرا نمی‌شود آن را در کنسول بنویسید یا از برنامهٔ چاپ بفرستید</translation>
    </message>
    <message>
        <source>measure a heater</source>
        <translation>اندازه‌گیری یک گرم‌کن</translation>
    </message>
    <message>
        <source>cannot %1 while heater.%2 is measured: a target of 0 ends that</source>
        <translation>هنگام اندازه‌گیری گرم‌کن heater.%2 ممکن نیست: %1؛ هدف 0 آن را پایان می‌دهد</translation>
    </message>
    <message>
        <source>an interrupted job waits: cancel it, or resume it, before a heater is measured</source>
        <translation>یک کار نیمه‌تمام در انتظار است: پیش از اندازه‌گیری گرم‌کن آن را لغو کنید یا ادامه دهید</translation>
    </message>
    <message>
        <source>%1 is measured, to be good at %2 C: full power for half of the way</source>
        <translation>%1 برای کار در %2 °C اندازه‌گیری می‌شود: توان کامل تا نیمهٔ راه</translation>
    </message>
    <message>
        <source>%1: the power is off, its curve is followed</source>
        <translation>%1: توان قطع است و منحنی آن دنبال می‌شود</translation>
    </message>
    <message>
        <source>%1 was not measured: %2</source>
        <translation>%1 اندازه‌گیری نشد: %2</translation>
    </message>
    <message>
        <source>%1: at %2 W it has %3 J/K, a dead time of %4 s, a lag of %5 s, and loses %6 W/K</source>
        <translation>%1: با %2 W دارای %3 J/K، زمان مردهٔ %4 s، تأخیر %5 s و اتلاف %6 W/K است</translation>
    </message>
    <message>
        <source>M303 names a heater by a whole number: E0 or H1 the first hot end, E-1 or H0 the bed</source>
        <translation>M303 گرم‌کن را با عدد صحیح می‌نامد: E0 یا H1 نخستین نازل و E-1 یا H0 بستر</translation>
    </message>
    <message>
        <source>heater.%1 is being measured: a target of 0 ends that</source>
        <translation>گرم‌کن heater.%1 در حال اندازه‌گیری است: هدف 0 آن را پایان می‌دهد</translation>
    </message>
    <message>
        <source>a heater is measured while all are off: switch them off first</source>
        <translation>یک گرم‌کن وقتی اندازه‌گیری می‌شود که همه خاموش باشند: نخست آن‌ها را خاموش کنید</translation>
    </message>
    <message>
        <source>%1 is at %2 C: from there to %3 C it is less than the %4 K that a measurement needs; let it cool, or choose a higher temperature</source>
        <translation>%1 اکنون %2 °C است: از آنجا تا %3 °C کمتر از %4 K است که اندازه‌گیری لازم دارد؛ بگذارید خنک شود یا دمای بالاتری برگزینید</translation>
    </message>
    <message>
        <source>M906 takes letters with numbers, as M906 X800 H400 or M906 I1 S800</source>
        <translation>M906 حرف با عدد می‌گیرد، مانند M906 X800 H400 یا M906 I1 S800</translation>
    </message>
    <message>
        <source>no motor moves %1 alone on this machine: name a joint by its number, as M906 I1 S800 for %2</source>
        <translation>در این ماشین هیچ موتوری %1 را به‌تنهایی حرکت نمی‌دهد: مفصل را با شماره‌اش بگویید، مانند M906 I1 S800 برای %2</translation>
    </message>
    <message>
        <source>I is the number of a joint, 1 to %1</source>
        <translation>I شمارهٔ یک مفصل است، 1 تا %1</translation>
    </message>
    <message>
        <source>M906 I needs the run current S or the hold current H</source>
        <translation>M906 I جریان حرکت S یا جریان نگهداری H می‌خواهد</translation>
    </message>
    <message>
        <source>S and H need the joint I</source>
        <translation>S و H مفصل I را می‌خواهند</translation>
    </message>
    <message>
        <source>M906 takes axes or the joint I, not both</source>
        <translation>M906 یا محورها را می‌گیرد یا مفصل I را، نه هر دو</translation>
    </message>
    <message>
        <source>no motor is named</source>
        <translation>هیچ موتوری نام برده نشده است</translation>
    </message>
    <message>
        <source>%1: a run current is 50 to %2 mA; max_current_ma of [joint.%3] in the machine file says how much the motor bears</source>
        <translation>%1: جریان حرکت از 50 تا %2 mA است؛ max_current_ma در [joint.%3] پروندهٔ ماشین می‌گوید موتور چه‌قدر تحمل می‌کند</translation>
    </message>
    <message>
        <source>%1: a hold current is 0 to the run current, %2 mA</source>
        <translation>%1: جریان نگهداری از 0 تا جریان حرکت، %2 mA، است</translation>
    </message>
    <message>
        <source>the measurement failed: is a motor connected?</source>
        <translation>اندازه‌گیری ناموفق بود: آیا موتوری وصل است؟</translation>
    </message>
    <message>
        <source>this node measures no currents</source>
        <translation>این گره جریان را اندازه نمی‌گیرد</translation>
    </message>
    <message>
        <source>the measurement does not end</source>
        <translation>اندازه‌گیری تمام نمی‌شود</translation>
    </message>
    <message>
        <source>%1: measured %2 Ohm, %3 mH, encoder offset %4: resistance_ohm, inductance_mh and encoder_offset_counts of [joint.%5.motor] in the machine file keep them</source>
        <translation>%1: اندازه‌گیری شد %2 اهم، %3 mH، انحراف انکودر %4: resistance_ohm، inductance_mh و encoder_offset_counts در [joint.%5.motor] پروندهٔ ماشین آن‌ها را نگه می‌دارند</translation>
    </message>
    <message>
        <source>%1: run current %2 mA, hold current %3 mA</source>
        <translation>%1: جریان حرکت %2 mA، جریان نگهداری %3 mA</translation>
    </message>
    <message>
        <source>no lines are open</source>
        <translation>هیچ جریان خطی باز نیست</translation>
    </message>
    <message>
        <source>move</source>
        <translation>حرکت</translation>
    </message>
    <message>
        <source>the feed is as programmed again</source>
        <translation>سرعت دوباره همان سرعت برنامه است</translation>
    </message>
    <message>
        <source>on the way back to the job&apos;s place %1: move the tool clear by hand, then resume</source>
        <translation>در راه برگشت به جای کار %1: ابزار را دستی دور کنید، سپس ادامه دهید</translation>
    </message>
    <message>
        <source>%1: what was printed is taken to stand on the table until the next job begins, or the machine is homed with no job interrupted</source>
        <translation>%1: فرض بر این است که آنچه چاپ شده روی میز است، تا کار بعدی آغاز شود یا دستگاه بدون کار قطع‌شده خانه‌یابی شود</translation>
    </message>
    <message>
        <source>frames reach %1 in another order than they were sent; it puts them right. A USB adapter does that: gs_usb keeps the order from Linux 6.6 on, candleLight&apos;s firmware from 2.0 on</source>
        <translation>فریم‌ها با ترتیبی جز ترتیب فرستادن به %1 می‌رسند؛ خودش آن‌ها را مرتب می‌کند. این کارِ یک مبدل USB است: gs_usb از لینوکس 6.6 و میان‌افزار candleLight از نسخهٔ 2.0 ترتیب را نگه می‌دارد</translation>
    </message>
    <message>
        <source>%1 cannot stand while cutter compensation is on: end it with G40 first</source>
        <translation>هنگامی که جبران شعاع ابزار روشن است، %1 مجاز نیست: نخست آن را با G40 پایان دهید</translation>
    </message>
    <message>
        <source>more than %1 lines without a move in the plane while cutter compensation is on</source>
        <translation>بیش از %1 خط بدون حرکت در صفحه، هنگامی که جبران شعاع ابزار روشن است</translation>
    </message>
    <message>
        <source>the arc&apos;s radius of %1 is not greater than the tool&apos;s, %2, on its inside</source>
        <translation>شعاع کمان، %1، در سمت درون از شعاع ابزار، %2، بزرگ‌تر نیست</translation>
    </message>
    <message>
        <source>the lead-in is too tight: the arc&apos;s radius of %1 is not greater than the tool&apos;s, %2</source>
        <translation>حرکت ورود بیش از اندازه تنگ است: شعاع کمان، %1، از شعاع ابزار، %2، بزرگ‌تر نیست</translation>
    </message>
    <message>
        <source>the lead-in is too short: the first move is %1 long, not more than the tool&apos;s radius, %2</source>
        <translation>حرکت ورود بیش از اندازه کوتاه است: طول نخستین حرکت %1 است و از شعاع ابزار، %2، بیشتر نیست</translation>
    </message>
    <message>
        <source>no lead-in arc of this direction leads from here to beside the path</source>
        <translation>هیچ کمان ورودی در این جهت از اینجا به کنار مسیر نمی‌رسد</translation>
    </message>
    <message>
        <source>the tool, of radius %1, does not come into the inside corner between line %2 and this one without cutting into them</source>
        <translation>ابزار با شعاع %1 بدون بریدن مسیر به گوشهٔ درونی میان خط %2 و این خط نمی‌رسد</translation>
    </message>
    <message>
        <source>the tool would cut into line %1 on its way along line %2</source>
        <translation>ابزار در راه خود در امتداد خط %2 مسیر خط %1 را می‌برید</translation>
    </message>
    <message>
        <source>after G40 a straight move (G0, G1) comes first: %1 cannot stand here</source>
        <translation>پس از G40 نخست یک حرکت راست (G0، G1) می‌آید: %1 اینجا مجاز نیست</translation>
    </message>
    <message>
        <source>%1 needs D, the tool&apos;s diameter</source>
        <translation>%1 به D، قطر ابزار، نیاز دارد</translation>
    </message>
    <message>
        <source>the diameter of T%1 is not known: write gcode.tool_diameter_mm in the machine file, or G41.1 D with the diameter</source>
        <translation>قطر ابزار T%1 معلوم نیست: gcode.tool_diameter_mm را در پروندهٔ ماشین بنویسید، یا قطر را با G41.1 D بدهید</translation>
    </message>
    <message>
        <source>the tool does not stand upright on the plane of %1: turn it with G53.1 first</source>
        <translation>ابزار بر صفحهٔ %1 عمود نیست: نخست آن را با G53.1 بچرخانید</translation>
    </message>
    <message>
        <source>cutter compensation belongs to a job: it looks ahead, which single lines cannot</source>
        <translation>جبران شعاع ابزار از آن یک کار است: به جلو می‌نگرد، و خط‌های تکی نمی‌توانند</translation>
    </message>
    <message>
        <source>a node that has axes: it latches where they were</source>
        <translation>گره‌ای که محور دارد: جای آن‌ها را ثبت می‌کند</translation>
    </message>
    <message>
        <source>%1 needs a decimal: G38.2 to G38.5</source>
        <translation>%1 رقم اعشار می‌خواهد: G38.2 تا G38.5</translation>
    </message>
    <message>
        <source>%1 needs a probe: the machine file has no [probe]</source>
        <translation>%1 پروب می‌خواهد: پروندهٔ ماشین [probe] ندارد</translation>
    </message>
    <message>
        <source>%1 needs a probe that can touch: the machine file&apos;s has where = &quot;simulated&quot;; one on a node probes, on a virtual one, too</source>
        <translation>%1 پروبی می‌خواهد که بتواند تماس بگیرد: در پروندهٔ ماشین where = &quot;simulated&quot; است؛ پروب روی یک گره، مجازی هم، می‌سنجد</translation>
    </message>
    <message>
        <source>%1 needs a feed for each minute: G94</source>
        <translation>%1 پیشروی در دقیقه می‌خواهد: G94</translation>
    </message>
    <message>
        <source>%1 cannot be used in a tilted plane: end it with G69 first</source>
        <translation>%1 در صفحهٔ کج به کار نمی‌رود: نخست با G69 پایانش دهید</translation>
    </message>
    <message>
        <source>%1 cannot be used while an object is left out</source>
        <translation>تا وقتی شیئی کنار گذاشته شده است %1 به کار نمی‌رود</translation>
    </message>
    <message>
        <source>probing goes at %1 mm/s: faster is not allowed by probe.speed_mm_per_s</source>
        <translation>پروب با %1 mm/s می‌رود: probe.speed_mm_per_s تندتر از آن را اجازه نمی‌دهد</translation>
    </message>
    <message>
        <source>%1 moves X, Y and Z alone</source>
        <translation>%1 تنها X، Y و Z را جابه‌جا می‌کند</translation>
    </message>
    <message>
        <source>%1 with a probe beside the tool (probe.offset_mm) needs A and C at 0</source>
        <translation>%1 با پروبی در کنار ابزار (probe.offset_mm) می‌خواهد A و C صفر باشند</translation>
    </message>
    <message>
        <source>%1 needs X, Y or Z of a place that is not where the tool stands</source>
        <translation>%1 به X، Y یا Z جایی نیاز دارد که ابزار آنجا نایستاده است</translation>
    </message>
    <message>
        <source>the job probes here: what follows is checked as if the probe touched at the table, or at the end of its move, and again with what is measured, just before it moves</source>
        <translation>کار اینجا پروب می‌کند: آنچه در پی می‌آید چنان بررسی می‌شود که گویی پروب روی میز یا در پایان حرکتش تماس گرفته است، و دوباره با آنچه سنجیده شد، درست پیش از حرکت</translation>
    </message>
    <message>
        <source>a macro or loop that probes works in a job, not as a line: the lines behind G38 have to know what it measures</source>
        <translation>ماکرو یا حلقه‌ای که پروب می‌کند در کار به کار می‌آید، نه به صورت خط: خط‌های پس از G38 باید بدانند چه سنجیده شد</translation>
    </message>
    <message>
        <source>a node has lost its position</source>
        <translation>گره‌ای موقعیت خود را از دست داده است</translation>
    </message>
    <message>
        <source>the job ends: it was stopped while it probed</source>
        <translation>کار پایان می‌یابد: هنگام پروب کردن متوقف شد</translation>
    </message>
    <message>
        <source>probing</source>
        <translation>در حال پروب کردن</translation>
    </message>
    <message>
        <source>the machine has no probe</source>
        <translation>ماشین پروب ندارد</translation>
    </message>
    <message>
        <source>the probe touches nothing, so that it cannot let go: nothing has moved</source>
        <translation>پروب با چیزی تماس ندارد، پس نمی‌تواند رها کند: چیزی جابه‌جا نشد</translation>
    </message>
    <message>
        <source>the probe touches before its move: nothing has moved</source>
        <translation>پروب پیش از حرکتش تماس دارد: چیزی جابه‌جا نشد</translation>
    </message>
    <message>
        <source>the probe has not let go before the end of its move</source>
        <translation>پروب تا پایان حرکتش رها نکرد</translation>
    </message>
    <message>
        <source>the probe has not touched before the end of its move</source>
        <translation>پروب تا پایان حرکتش تماس نگرفت</translation>
    </message>
    <message>
        <source>the probe&apos;s node does not answer</source>
        <translation>گرهٔ پروب پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>a pin</source>
        <translation>یک پین</translation>
    </message>
    <message>
        <source>a probe on an input of a node, [probe] with where = &quot;node&quot;: its line</source>
        <translation>پروبی روی ورودی یک گره، [probe] با where = &quot;node&quot;: خط آن</translation>
    </message>
    <message>
        <source>a heat node that has its table, [node.%1], with axis_pairs = 0</source>
        <translation>یک گرهٔ حرارتی که جدول خود را دارد، [node.%1]، با axis_pairs = 0</translation>
    </message>
    <message>
        <source>node %1, which moves the probe&apos;s pin, is not in operation</source>
        <translation>گرهٔ %1 که پین پروب را حرکت می‌دهد در حال کار نیست</translation>
    </message>
    <message>
        <source>node %1 refuses to move the probe&apos;s pin: %2</source>
        <translation>گرهٔ %1 از حرکت دادن پین پروب خودداری می‌کند: %2</translation>
    </message>
    <message>
        <source>the probe&apos;s pin has not come out</source>
        <translation>پین پروب بیرون نیامد</translation>
    </message>
    <message>
        <source>the probe&apos;s pin has not gone in: look at it before anything moves</source>
        <translation>پین پروب داخل نرفت: پیش از هر حرکتی آن را بررسی کنید</translation>
    </message>
    <message>
        <source>the probe is in alarm, after a reset, too: look at its pin before anything moves</source>
        <translation>پروب پس از بازنشانی هم در هشدار است: پیش از هر حرکتی پین آن را بررسی کنید</translation>
    </message>
    <message>
        <source>node %1 does not say where the probe&apos;s pin is</source>
        <translation>گرهٔ %1 نمی‌گوید پین پروب کجاست</translation>
    </message>
    <message>
        <source>putting the probe&apos;s pin out</source>
        <translation>بیرون آوردن پین پروب</translation>
    </message>
    <message>
        <source>drawing the probe&apos;s pin in</source>
        <translation>داخل بردن پین پروب</translation>
    </message>
    <message>
        <source>the probe has told of a contact, and its node knows of none</source>
        <translation>پروب از تماسی خبر داد و گره‌اش هیچ تماسی نمی‌شناسد</translation>
    </message>
    <message>
        <source>the probe has touched at a time that is not one of its move</source>
        <translation>پروب در زمانی تماس گرفت که از آنِ حرکتش نیست</translation>
    </message>
    <message>
        <source>%1 has no effect: the machine file has no [probe]</source>
        <translation>%1 اثری ندارد: پروندهٔ ماشین [probe] ندارد</translation>
    </message>
    <message>
        <source>%1 has no effect: a probe with where = &quot;simulated&quot; cannot touch</source>
        <translation>%1 اثری ندارد: پروب با where = &quot;simulated&quot; نمی‌تواند تماس بگیرد</translation>
    </message>
    <message>
        <source>a mesh&apos;s name has %1 letters at most</source>
        <translation>نام مش حداکثر %1 حرف دارد</translation>
    </message>
    <message>
        <source>%1 needs A and C at 0</source>
        <translation>%1 می‌خواهد A و C روی 0 باشند</translation>
    </message>
    <message>
        <source>the area to be probed lies outside of [mesh] of the machine file: %1 is %2 to %3 mm</source>
        <translation>ناحیهٔ پروب بیرون از [mesh] پروندهٔ ماشین است: %1 از %2 تا %3 mm است</translation>
    </message>
    <message>
        <source>a mesh has 2 to %1 points along an axis</source>
        <translation>مش در راستای هر محور 2 تا %1 نقطه دارد</translation>
    </message>
    <message>
        <source>%1 of this form has no effect: G29 alone, or P1, probes the whole bed</source>
        <translation>%1 به این شکل اثری ندارد: G29 تنها، یا P1، همهٔ بستر را می‌سنجد</translation>
    </message>
    <message>
        <source>M421 needs the point I J, counted from 0, and its height Z, or Q to add to it</source>
        <translation>M421 نقطهٔ I J را که از 0 شمرده می‌شود و ارتفاع Z، یا Q برای افزودن، می‌خواهد</translation>
    </message>
    <message>
        <source>the height over which a mesh fades cannot be negative</source>
        <translation>ارتفاعی که مش در آن محو می‌شود نمی‌تواند منفی باشد</translation>
    </message>
    <message>
        <source>a bed mesh is put in force here: what follows is checked with the one in force now, and again just before it moves</source>
        <translation>اینجا یک مش بستر به کار می‌افتد: آنچه می‌آید با مش کنونی بررسی می‌شود و درست پیش از حرکت دوباره</translation>
    </message>
    <message>
        <source>the bed is measured when the machine is ready: bring up and home it first</source>
        <translation>بستر وقتی سنجیده می‌شود که ماشین آماده است: نخست آن را راه‌اندازی و خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>a job is under way: the bed mesh stays as it is</source>
        <translation>کاری در جریان است: مش بستر همان که هست می‌ماند</translation>
    </message>
    <message>
        <source>the bed mesh %1 was measured with another geometry of the machine: it is not used, measure the bed again</source>
        <translation>مش بستر %1 با هندسهٔ دیگری از ماشین سنجیده شده است: به کار نمی‌رود، بستر را دوباره بسنجید</translation>
    </message>
    <message>
        <source>the bed is %1 to %2 mm from the table of the machine file; mesh.limit_mm allows %3 mm: level it, or correct the machine file</source>
        <translation>بستر %1 تا %2 mm از میزِ پروندهٔ ماشین فاصله دارد؛ mesh.limit_mm تا %3 mm اجازه می‌دهد: بستر را تراز کنید یا پروندهٔ ماشین را درست کنید</translation>
    </message>
    <message>
        <source>a mesh of up to %1 mm has to fade over at least %2 mm: found %3</source>
        <translation>مشی تا %1 mm باید دست‌کم در %2 mm محو شود: یافته %3</translation>
    </message>
    <message>
        <source>there is no mesh %1</source>
        <translation>مش %1 وجود ندارد</translation>
    </message>
    <message>
        <source>Bed X: %1 Y: %2 Z: %3</source>
        <translation>بستر X: %1 Y: %2 Z: %3</translation>
    </message>
    <message>
        <source>no bed mesh is in force</source>
        <translation>هیچ مش بستری در کار نیست</translation>
    </message>
    <message>
        <source>the mesh in force has %1 x %2 points</source>
        <translation>مشی که در کار است %1 در %2 نقطه دارد</translation>
    </message>
    <message>
        <source>no bed mesh is kept: the bed is taken as even</source>
        <translation>هیچ مش بستری نگه داشته نشده است: بستر هموار گرفته می‌شود</translation>
    </message>
    <message>
        <source>the bed was not measured as a whole</source>
        <translation>همهٔ بستر سنجیده نشد</translation>
    </message>
    <message>
        <source>bed mesh %1: %2 x %3 points, %4 to %5 mm</source>
        <translation>مش بستر %1: %2 در %3 نقطه، %4 تا %5 mm</translation>
    </message>
    <message>
        <source>the tool&apos;s place cannot be named</source>
        <translation>جای ابزار را نمی‌توان نامید</translation>
    </message>
    <message>
        <source>echo writes no files here: it tells the operator</source>
        <translation>echo اینجا پرونده نمی‌نویسد: به کاربر می‌گوید</translation>
    </message>
    <message>
        <source>the text is too long (500 letters at most)</source>
        <translation>متن بسیار دراز است (حداکثر 500 حرف)</translation>
    </message>
    <message>
        <source>expected an operator or %1</source>
        <translation>عملگر یا %1 انتظار می‌رفت</translation>
    </message>
    <message>
        <source>the job aborts itself here</source>
        <translation>کار اینجا خود را متوقف می‌کند</translation>
    </message>
    <message>
        <source>the job aborts itself here: %1</source>
        <translation>کار اینجا خود را متوقف می‌کند: %1</translation>
    </message>
    <message>
        <source>set changes var.NAME or global.NAME</source>
        <translation>set مقدار var.NAME یا global.NAME را تغییر می‌دهد</translation>
    </message>
    <message>
        <source>expected %1</source>
        <translation>مورد انتظار: %1</translation>
    </message>
    <message>
        <source>nothing can follow the value</source>
        <translation>پس از مقدار چیزی نمی‌تواند بیاید</translation>
    </message>
    <message>
        <source>%1 has no value yet</source>
        <translation>%1 هنوز مقداری ندارد</translation>
    </message>
    <message>
        <source>%1 exists already: set changes it</source>
        <translation>%1 از پیش هست: set آن را تغییر می‌دهد</translation>
    </message>
    <message>
        <source>too many variables (%1 at most)</source>
        <translation>متغیرها زیادند (حداکثر %1)</translation>
    </message>
    <message>
        <source>the arguments of a macro are letters with numbers</source>
        <translation>آرگومان‌های ماکرو حرف‌هایی با عدد هستند</translation>
    </message>
    <message>
        <source>no object can be left out while cutter compensation is on</source>
        <translation>هنگامی که جبران شعاع ابزار روشن است، هیچ جسمی را نمی‌توان کنار گذاشت</translation>
    </message>
    <message>
        <source>if and while belong to a job: a single line can only call a macro</source>
        <translation>if و while از آنِ کارند: یک سطر تنها می‌تواند ماکرو فراخواند</translation>
    </message>
    <message>
        <source>%1 is in no loop</source>
        <translation>%1 در حلقه‌ای نیست</translation>
    </message>
    <message>
        <source>expected a number, not %1</source>
        <translation>عدد انتظار می‌رفت، نه %1</translation>
    </message>
    <message>
        <source>expected a condition (true or false), not %1</source>
        <translation>شرط (true یا false) انتظار می‌رفت، نه %1</translation>
    </message>
    <message>
        <source>the index %1 is too large: there are %2</source>
        <translation>نمایهٔ %1 بسیار بزرگ است: %2 تا هست</translation>
    </message>
    <message>
        <source>%1 cannot be known when the text is read; what can: %2</source>
        <translation>%1 هنگام خواندن متن دانستنی نیست؛ دانستنی‌ها: %2</translation>
    </message>
    <message>
        <source>expected a value</source>
        <translation>مقدار انتظار می‌رفت</translation>
    </message>
    <message>
        <source># counts the letters of a text, or a list of the object model</source>
        <translation># حرف‌های یک متن یا فهرستی از مدل اشیا را می‌شمارد</translation>
    </message>
    <message>
        <source>the text needs a closing quotation mark</source>
        <translation>متن گیومهٔ پایانی ندارد</translation>
    </message>
    <message>
        <source>expected a name: letters, digits and _</source>
        <translation>نام انتظار می‌رفت: حرف، رقم و _</translation>
    </message>
    <message>
        <source>the name is too long (64 letters at most)</source>
        <translation>نام بسیار دراز است (حداکثر 64 حرف)</translation>
    </message>
    <message>
        <source>an index is a whole number from 0</source>
        <translation>نمایه عددی صحیح از 0 به بالا است</translation>
    </message>
    <message>
        <source>a function has 16 arguments at most</source>
        <translation>تابع حداکثر 16 آرگومان دارد</translation>
    </message>
    <message>
        <source>there is no function %1 of %2 values</source>
        <translation>تابع %1 با %2 مقدار وجود ندارد</translation>
    </message>
    <message>
        <source>iterations has a value in a loop alone</source>
        <translation>iterations تنها در حلقه مقدار دارد</translation>
    </message>
    <message>
        <source>the call gives no %1</source>
        <translation>فراخوانی %1 را نمی‌دهد</translation>
    </message>
    <message>
        <source>no job is read</source>
        <translation>هیچ کاری خوانده نمی‌شود</translation>
    </message>
    <message>
        <source>leave an object out</source>
        <translation>کنار گذاشتن یک جسم</translation>
    </message>
    <message>
        <source>the job names no objects</source>
        <translation>کار نام هیچ جسمی را نمی‌برد</translation>
    </message>
    <message>
        <source>the job has no object %1; it has %2</source>
        <translation>کار جسم %1 را ندارد؛ دارد: %2</translation>
    </message>
    <message>
        <source>the object %1 is left out from line %2 on: what is before it is planned already</source>
        <translation>جسم %1 از سطر %2 به بعد کنار گذاشته می‌شود: آنچه پیش از آن است برنامه‌ریزی شده</translation>
    </message>
    <message>
        <source>while a job runs M486 takes P with the number of an object</source>
        <translation>هنگام اجرای کار، M486 تنها P با شمارهٔ یک جسم می‌پذیرد</translation>
    </message>
    <message>
        <source>no job runs of which an object could be left out</source>
        <translation>کاری در حال اجرا نیست که بتوان جسمی از آن را کنار گذاشت</translation>
    </message>
    <message>
        <source>A motor phase is shorted to ground</source>
        <translation>یک فاز موتور به زمین اتصال کوتاه است</translation>
    </message>
    <message>
        <source>a motor phase is shorted to ground</source>
        <translation>یک فاز موتور به زمین اتصال کوتاه است</translation>
    </message>
    <message>
        <source>A motor phase is shorted to the supply</source>
        <translation>یک فاز موتور به تغذیه اتصال کوتاه است</translation>
    </message>
    <message>
        <source>a motor phase is shorted to the supply</source>
        <translation>یک فاز موتور به تغذیه اتصال کوتاه است</translation>
    </message>
    <message>
        <source>A motor driver has lost its settings</source>
        <translation>یک راه‌انداز موتور تنظیماتش را از دست داده است</translation>
    </message>
    <message>
        <source>a motor driver has lost its settings: its supply was gone</source>
        <translation>یک راه‌انداز موتور تنظیماتش را از دست داده است: تغذیهٔ آن قطع شده بود</translation>
    </message>
    <message>
        <source>check the motor supply, then clear and home again</source>
        <translation>تغذیهٔ موتورها را بررسی کنید، سپس هشدار را رفع کنید و دوباره خانه‌یابی کنید</translation>
    </message>
    <message>
        <source>A motor driver does not answer</source>
        <translation>یک راه‌انداز موتور پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>a motor driver does not answer by UART or SPI</source>
        <translation>یک راه‌انداز موتور از راه UART یا SPI پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>check the motor supply, the driver&apos;s seat and its jumpers for UART or SPI, then clear</source>
        <translation>تغذیهٔ موتورها، نشستن راه‌انداز در جایش و جامپرهای UART یا SPI آن را بررسی کنید، سپس هشدار را رفع کنید</translation>
    </message>
    <message>
        <source>an NMT command that does not carry the session&apos;s check value was refused (%1)</source>
        <translation>دستور NMT بدون مقدار بررسی نشست رد شد (%1)</translation>
    </message>
    <message>
        <source>a write of object %1 that does not carry the session&apos;s check value was refused</source>
        <translation>نوشتن شیء %1 بدون مقدار بررسی نشست رد شد</translation>
    </message>
    <message>
        <source>a change of the rate that does not carry the session&apos;s check value was refused</source>
        <translation>تغییر نرخ بدون مقدار بررسی نشست رد شد</translation>
    </message>
    <message>
        <source>a controlword or set point that does not carry the session&apos;s check value was refused</source>
        <translation>کلمهٔ کنترل یا مقدار تنظیم بدون مقدار بررسی نشست رد شد</translation>
    </message>
    <message>
        <source>a time stamp of SYNC that does not carry the session&apos;s check value was refused</source>
        <translation>مهر زمانی SYNC بدون مقدار بررسی نشست رد شد</translation>
    </message>
    <message>
        <source>while SYNC was silent its session was open, and a frame that nobody vouched for was obeyed (COB-ID %1)</source>
        <translation>تا SYNC ساکت بود نشستش باز بود و از قابی که کسی آن را تأیید نکرده بود پیروی شد (COB-ID %1)</translation>
    </message>
    <message>
        <source>A node has refused a frame of another device</source>
        <translation>گره‌ای قاب دستگاهی دیگر را رد کرد</translation>
    </message>
    <message>
        <source>a frame without the session&apos;s check value was refused</source>
        <translation>قابی بدون مقدار بررسی نشست رد شد</translation>
    </message>
    <message>
        <source>the probe&apos;s pin is out</source>
        <translation>پین پروب بیرون است</translation>
    </message>
    <message>
        <source>the probe&apos;s pin is in</source>
        <translation>پین پروب داخل است</translation>
    </message>
    <message>
        <source>the machine has no probe with a pin</source>
        <translation>ماشین پروبی با پین ندارد</translation>
    </message>
    <message>
        <source>move the probe&apos;s pin</source>
        <translation>حرکت دادن پین پروب</translation>
    </message>
    <message>
        <source>M280 moves the probe&apos;s pin: S10 out, S90 in, S120 self test, S160 ends an alarm</source>
        <translation>M280 پین پروب را حرکت می‌دهد: S10 بیرون، S90 داخل، S120 خودآزمایی، S160 پایان هشدار</translation>
    </message>
    <message>
        <source>the machine has no accelerometer: [accelerometer] of the machine file names its node</source>
        <translation>ماشین شتاب‌سنج ندارد: [accelerometer] پروندهٔ ماشین گرهٔ آن را نام می‌برد</translation>
    </message>
    <message>
        <source>M956 S1 begins to measure, S0 ends it</source>
        <translation>M956 S1 اندازه‌گیری را آغاز می‌کند، S0 آن را پایان می‌دهد</translation>
    </message>
    <message>
        <source>a measurement begins while nothing runs</source>
        <translation>اندازه‌گیری هنگامی آغاز می‌شود که چیزی در حال اجرا نیست</translation>
    </message>
    <message>
        <source>nothing is measured: M956 S1 begins it</source>
        <translation>چیزی اندازه‌گیری نمی‌شود: M956 S1 آن را آغاز می‌کند</translation>
    </message>
    <message>
        <source>its node has no accelerometer</source>
        <translation>گرهٔ آن شتاب‌سنج ندارد</translation>
    </message>
    <message>
        <source>the accelerometer does not answer its node</source>
        <translation>شتاب‌سنج به گرهٔ خود پاسخ نمی‌دهد</translation>
    </message>
    <message>
        <source>it was too short: %1 s at least</source>
        <translation>بسیار کوتاه بود: دست‌کم %1 ثانیه</translation>
    </message>
    <message>
        <source>a code of a scale that tells no place</source>
        <translation>کد خط‌کشی که مکان نمی‌گوید</translation>
    </message>
    <message>
        <source>absolute_bits, or no gray_code</source>
        <translation>absolute_bits، یا بدون gray_code</translation>
    </message>
    <message>
        <source>8 to 30 bits</source>
        <translation>۸ تا ۳۰ بیت</translation>
    </message>
    <message>
        <source>an encoder and an absolute scale on one port</source>
        <translation>انکودر و خط‌کش مطلق روی یک پورت</translation>
    </message>
    <message>
        <source>encoder = &quot;none&quot;, or a scale of pulses</source>
        <translation>encoder = &quot;none&quot;، یا خط‌کش پالسی</translation>
    </message>
    <message>
        <source>a scale that begins anew every %1 mm</source>
        <translation>خط‌کشی که هر %1 mm از نو آغاز می‌شود</translation>
    </message>
    <message>
        <source>one that is at least %1 mm long at this speed</source>
        <translation>خط‌کشی که با این سرعت دست‌کم %1 mm باشد</translation>
    </message>
    <message>
        <source>set the job aside</source>
        <translation>کنار گذاشتن کار</translation>
    </message>
    <message>
        <source>move the filament</source>
        <translation>راندن فیلامنت</translation>
    </message>
    <message>
        <source>no job is held that could be set aside</source>
        <translation>کار مکث‌کرده‌ای نیست که کنار گذاشته شود</translation>
    </message>
    <message>
        <source>the tool is on its way: resume or cancel first</source>
        <translation>ابزار در راه است: نخست ادامه دهید یا لغو کنید</translation>
    </message>
    <message>
        <source>the probe is on its way: resume or cancel first</source>
        <translation>پراب در راه است: نخست ادامه دهید یا لغو کنید</translation>
    </message>
    <message>
        <source>the tool is not parked: %1</source>
        <translation>ابزار پارک نشد: %1</translation>
    </message>
    <message>
        <source>change the filament: load, purge, then resume goes on with the job</source>
        <translation>فیلامنت را عوض کنید: بارگذاری، تخلیه، سپس ادامه دهید تا کار پیش برود</translation>
    </message>
    <message>
        <source>the job is set aside: jog, heat and extrude, then resume goes on with it</source>
        <translation>کار کنار گذاشته شد: حرکت دستی، گرم کردن و اکستروژن آزاد است؛ سپس ادامه دهید تا کار پیش برود</translation>
    </message>
    <message>
        <source>nothing here feeds filament</source>
        <translation>اینجا چیزی فیلامنت نمی‌راند</translation>
    </message>
    <message>
        <source>%1 is 0 in the machine file</source>
        <translation>%1 در پروندهٔ ماشین 0 است</translation>
    </message>
    <message>
        <source>this gateway cannot be started anew from here</source>
        <translation>این درگاه از اینجا از نو آغاز نمی‌شود</translation>
    </message>
    <message>
        <source>the gateway starts anew when the machine rests and no job is under way or interrupted</source>
        <translation>درگاه هنگامی از نو آغاز می‌شود که ماشین ایستاده باشد و هیچ کاری در جریان یا قطع‌شده نباشد</translation>
    </message>
    <message>
        <source>false: that converter measures pt100 and pt1000</source>
        <translation>false: آن مبدل pt100 و pt1000 را اندازه می‌گیرد</translation>
    </message>
    <message>
        <source>50 or 60</source>
        <translation>50 یا 60</translation>
    </message>
    <message>
        <source>%1 at %2 C</source>
        <translation>%1 در %2 C</translation>
    </message>
    <message>
        <source>a resistance that falls all the way as it gets hotter</source>
        <translation>مقاومتی که با گرم‌شدن پیوسته کم شود</translation>
    </message>
    <message>
        <source>at most %1, which its sensor is made for</source>
        <translation>حداکثر %1 که حسگرش برای آن ساخته شده است</translation>
    </message>
    <message>
        <source>at most %1: with limit_c, %2 above it, its sensor is made for no more</source>
        <translation>حداکثر %1: با limit_c که %2 بالاتر از آن است، حسگرش برای بیش از آن ساخته نشده است</translation>
    </message>
    <message>
        <source>%1 was never measured: a heater or sensor that has slipped half out of its hole may stay unseen. Measure it: tune, or M303</source>
        <translation>%1 هرگز اندازه‌گیری نشده است: گرم‌کن یا حسگری که نیمه از جای خود بیرون آمده شاید دیده نشود. آن را اندازه بگیرید: تنظیم، یا M303</translation>
    </message>
    <message>
        <source>an address http://HOST/PATH, https://HOST/PATH or, on this computer, :PORT/PATH</source>
        <translation>نشانی: http://HOST/PATH، https://HOST/PATH یا روی همین رایانه :PORT/PATH</translation>
    </message>
    <message>
        <source>10 to 1000: 110 on most modules, 75 with a TMC5160</source>
        <translation>10 تا 1000: در بیشتر ماژول‌ها 110، با TMC5160 برابر 75</translation>
    </message>
    <message>
        <source>homing by the load of a driver that nobody speaks to</source>
        <translation>خانه‌یابی با بار درایوری که کسی با آن سخن نمی‌گوید</translation>
    </message>
    <message>
        <source>a method of 17..22 or 37, or no stands_alone</source>
        <translation>روش 17 تا 22 یا 37، یا بدون stands_alone</translation>
    </message>
    <message>
        <source>settings for a driver that nobody speaks to</source>
        <translation>تنظیمات برای درایوری که کسی با آن سخن نمی‌گوید</translation>
    </message>
    <message>
        <source>stands_alone alone, or without it</source>
        <translation>تنها stands_alone، یا بدون آن</translation>
    </message>
    <message>
        <source>a driver behind step and direction, and a motor that the node drives itself</source>
        <translation>درایوری پشت پله و جهت، و موتوری که خود گره آن را می‌راند</translation>
    </message>
    <message>
        <source>one of the two tables</source>
        <translation>یکی از دو جدول</translation>
    </message>
    <message>
        <source>two nodes use the id %1: one says that it is operational, the other that it is not</source>
        <translation>دو گره شناسهٔ %1 را به کار می‌برند: یکی می‌گوید در حال کار است و دیگری می‌گوید نیست</translation>
    </message>
</context>
<context>
    <name>GatewayWords</name>
    <message>
        <source>expected %1</source>
        <translation>مورد انتظار: %1</translation>
    </message>
</context>
<context>
    <name>StateWords</name>
    <message>
        <source>Motors off</source>
        <translation>موتورها خاموش</translation>
    </message>
    <message>
        <source>Waking the nodes</source>
        <translation>بیدار کردن گره‌ها</translation>
    </message>
    <message>
        <source>Not homed</source>
        <translation>خانه‌یابی نشده</translation>
    </message>
    <message>
        <source>Homing</source>
        <translation>خانه‌یابی</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>آماده</translation>
    </message>
    <message>
        <source>Moving</source>
        <translation>در حرکت</translation>
    </message>
    <message>
        <source>Checking the job</source>
        <translation>بررسی کار</translation>
    </message>
    <message>
        <source>Printing</source>
        <translation>در حال چاپ</translation>
    </message>
    <message>
        <source>Pausing</source>
        <translation>در حال مکث</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>Cancelling</source>
        <translation>در حال لغو</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>در حال توقف</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>متوقف</translation>
    </message>
    <message>
        <source>Alarm</source>
        <translation>هشدار</translation>
    </message>
    <message>
        <source>Unknown</source>
        <translation>نامعلوم</translation>
    </message>
    <message>
        <source>Home the machine to wake the motors and find the carriages.</source>
        <translation>برای بیدار کردن موتورها و یافتن حامل‌ها، ماشین را خانه‌یابی کنید.</translation>
    </message>
    <message>
        <source>Home the machine: positions are not known yet.</source>
        <translation>ماشین را خانه‌یابی کنید: موقعیت‌ها هنوز معلوم نیستند.</translation>
    </message>
    <message>
        <source>Choose a job and start it, or jog the tool.</source>
        <translation>کاری را برگزینید و آغاز کنید، یا ابزار را دستی حرکت دهید.</translation>
    </message>
    <message>
        <source>All carriages rest on the path. Resume or cancel.</source>
        <translation>همهٔ حامل‌ها روی مسیر ایستاده‌اند. ادامه دهید یا لغو کنید.</translation>
    </message>
    <message>
        <source>Make sure that the machine is safe, then clear the stop.</source>
        <translation>از امن بودن ماشین مطمئن شوید، سپس توقف را رفع کنید.</translation>
    </message>
    <message>
        <source>Read the alarm, remove its cause, then clear it.</source>
        <translation>هشدار را بخوانید، علت را برطرف کنید، سپس آن را رفع کنید.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::AlarmsPage</name>
    <message>
        <source>Clear</source>
        <translation>رفع</translation>
    </message>
    <message>
        <source>No alarm is open.</source>
        <translation>هیچ هشدار بازی نیست.</translation>
    </message>
    <message>
        <source>What has happened, newest first</source>
        <translation>رویدادها، تازه‌ترین در آغاز</translation>
    </message>
    <message>
        <source>Messages, too</source>
        <translation>پیام‌ها هم</translation>
    </message>
    <message>
        <source>No alarms so far.</source>
        <translation>تاکنون هشداری نبوده است.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::AxesModel</name>
    <message>
        <source>Axis</source>
        <translation>محور</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>موقعیت</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>اندازه‌گیری</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>خطا</translation>
    </message>
    <message>
        <source>By scale</source>
        <translation>با خط‌کش</translation>
    </message>
    <message>
        <source>Error by scale</source>
        <translation>خطا با خط‌کش</translation>
    </message>
    <message>
        <source>%1 µm</source>
        <translation>%1 µm</translation>
    </message>
    <message>
        <source>Travel</source>
        <translation>کورس</translation>
    </message>
    <message>
        <source>Current</source>
        <translation>جریان</translation>
    </message>
    <message>
        <source>Drive</source>
        <translation>درایو</translation>
    </message>
    <message>
        <source>Switch</source>
        <translation>کلید</translation>
    </message>
    <message>
        <source>Node</source>
        <translation>گره</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>%1 of %2 A</source>
        <translation>%1 / %2 A</translation>
    </message>
    <message>
        <source>Fault</source>
        <translation>خطا</translation>
    </message>
    <message>
        <source>On</source>
        <translation>روشن</translation>
    </message>
    <message>
        <source>Off</source>
        <translation>خاموش</translation>
    </message>
    <message>
        <source>Hit</source>
        <translation>فعال</translation>
    </message>
    <message>
        <source>Free</source>
        <translation>آزاد</translation>
    </message>
    <message>
        <source>Counts</source>
        <translation>شمارش</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>حرکت</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>نگهداری</translation>
    </message>
    <message>
        <source>Stage</source>
        <translation>طبقهٔ قدرت</translation>
    </message>
    <message>
        <source>%1 A</source>
        <translation>%1 A</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::BenchCard</name>
    <message>
        <source>kinebus-card has ended</source>
        <translation>kinebus-card پایان یافت</translation>
    </message>
    <message>
        <source>the program kinebus-card was not found: install the package kinebus-cli</source>
        <translation>برنامهٔ kinebus-card یافت نشد: بستهٔ kinebus-cli را نصب کنید</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::BenchWindow</name>
    <message>
        <source>not ready</source>
        <translation>آماده نیست</translation>
    </message>
    <message>
        <source>switched off</source>
        <translation>خاموش</translation>
    </message>
    <message>
        <source>ready to switch on</source>
        <translation>آمادهٔ روشن شدن</translation>
    </message>
    <message>
        <source>switched on, without current</source>
        <translation>روشن، بدون جریان</translation>
    </message>
    <message>
        <source>holds</source>
        <translation>نگه می‌دارد</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>ایستاده</translation>
    </message>
    <message>
        <source>stops with a fault</source>
        <translation>با خرابی می‌ایستد</translation>
    </message>
    <message>
        <source>fault</source>
        <translation>خرابی</translation>
    </message>
    <message>
        <source>Refused: %1</source>
        <translation>رد شد: %1</translation>
    </message>
    <message>
        <source>The card is silent: %1. It is asked again by itself.</source>
        <translation>کارت پاسخ نمی‌دهد: %1. خودکار دوباره پرسیده می‌شود.</translation>
    </message>
    <message>
        <source>Closed. A motor that has power holds on.</source>
        <translation>بسته شد. موتوری که برق دارد همچنان نگه می‌دارد.</translation>
    </message>
    <message>
        <source>A driver card on a bench</source>
        <translation>کارت راه‌انداز روی میز کار</translation>
    </message>
    <message>
        <source>CAN interface</source>
        <translation>رابط CAN</translation>
    </message>
    <message>
        <source>Node id</source>
        <translation>شناسهٔ گره</translation>
    </message>
    <message>
        <source>Stop the motor</source>
        <translation>توقف موتور</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>ذخیره</translation>
    </message>
    <message>
        <source>Currents and what was measured are kept through power-off; no motor has power then</source>
        <translation>جریان‌ها و آنچه اندازه گرفته شد با قطع برق می‌مانند؛ در آن هنگام هیچ موتوری برق ندارد</translation>
    </message>
    <message>
        <source>Motor %1</source>
        <translation>موتور %1</translation>
    </message>
    <message>
        <source>Run current</source>
        <translation>جریان حرکت</translation>
    </message>
    <message>
        <source>Hold current</source>
        <translation>جریان نگهداری</translation>
    </message>
    <message>
        <source>Turns</source>
        <translation>دور</translation>
    </message>
    <message>
        <source>Turns a second</source>
        <translation>دور در ثانیه</translation>
    </message>
    <message>
        <source>Of a motor with 200 steps a turn</source>
        <translation>برای موتوری با ۲۰۰ گام در دور</translation>
    </message>
    <message>
        <source>Set currents</source>
        <translation>تنظیم جریان‌ها</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>عقب</translation>
    </message>
    <message>
        <source>On</source>
        <translation>جلو</translation>
    </message>
    <message>
        <source>Turn motor %1 back</source>
        <translation>چرخاندن موتور %1 به عقب</translation>
    </message>
    <message>
        <source>Turn motor %1 on</source>
        <translation>چرخاندن موتور %1 به جلو</translation>
    </message>
    <message>
        <source>Measure the motor</source>
        <translation>اندازه‌گیری موتور</translation>
    </message>
    <message>
        <source>The node measures resistance, inductance and the encoder&apos;s offset while the motor stands</source>
        <translation>گره هنگام ایست موتور مقاومت، القاوری و انحراف انکودر را اندازه می‌گیرد</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>بستن</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>باز کردن</translation>
    </message>
    <message>
        <source>Let go</source>
        <translation>رها کردن</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>نگه داشتن</translation>
    </message>
    <message>
        <source>Without gateway and machine file: this computer&apos;s CAN interface, and the node&apos;s id.</source>
        <translation>بدون درگاه و پروندهٔ ماشین: رابط CAN این رایانه و شناسهٔ گره.</translation>
    </message>
    <message>
        <source>%1, serial number %2</source>
        <translation>%1، شمارهٔ سریال %2</translation>
    </message>
    <message>
        <source>Switches: %1</source>
        <translation>کلیدها: %1</translation>
    </message>
    <message>
        <source>Errors that it has told: %1</source>
        <translation>خطاهایی که اعلام کرده است: %1</translation>
    </message>
    <message>
        <source>%1, error %2</source>
        <translation>%1، خطای %2</translation>
    </message>
    <message>
        <source>%1 counts, %2 turns</source>
        <translation>%1 شمارش، %2 دور</translation>
    </message>
    <message>
        <source>%1 measured, stage at %2, supply %3</source>
        <translation>%1 اندازه‌گیری شد، طبقهٔ توان %2، تغذیه %3</translation>
    </message>
    <message>
        <source>Measured: %1, no encoder</source>
        <translation>اندازه‌گیری شد: %1، بدون انکودر</translation>
    </message>
    <message>
        <source>Measured: %1, encoder offset %2</source>
        <translation>اندازه‌گیری شد: %1، انحراف انکودر %2</translation>
    </message>
    <message>
        <source>The card keeps its settings through power-off.</source>
        <translation>کارت تنظیم‌هایش را با قطع برق نگه می‌دارد.</translation>
    </message>
    <message>
        <source>Stopped by its ramp; the motor holds.</source>
        <translation>با رمپ خود ایستاد؛ موتور نگه می‌دارد.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ConnectPage</name>
    <message>
        <source>Connect to a machine</source>
        <translation>به یک ماشین وصل شوید</translation>
    </message>
    <message>
        <source>A gateway appears here as soon as its USB cable is plugged in or its daemon runs on this computer.</source>
        <translation>همین که کابل USB درگاه وصل شود یا سرویس آن روی این رایانه اجرا شود، درگاه اینجا دیده می‌شود.</translation>
    </message>
    <message>
        <source>Gateways</source>
        <translation>درگاه‌ها</translation>
    </message>
    <message>
        <source>None found yet.</source>
        <translation>هنوز چیزی پیدا نشده است.</translation>
    </message>
    <message>
        <source>Demo machine</source>
        <translation>ماشین نمایشی</translation>
    </message>
    <message>
        <source>The whole machine, simulated on this computer: upload, home and print without hardware.</source>
        <translation>کل ماشین، شبیه‌سازی‌شده روی این رایانه: بدون سخت‌افزار بفرستید، خانه‌یابی و چاپ کنید.</translation>
    </message>
    <message>
        <source>Try the demo</source>
        <translation>اجرای نمایشی</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>قطع اتصال</translation>
    </message>
    <message>
        <source>The demo machine does not run: %1</source>
        <translation>ماشین نمایشی اجرا نمی‌شود: %1</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>اتصال</translation>
    </message>
    <message>
        <source>Connect to %1</source>
        <translation>اتصال به %1</translation>
    </message>
    <message>
        <source>Connecting to %1…</source>
        <translation>در حال اتصال به %1…</translation>
    </message>
    <message>
        <source>%1 does not answer: %2</source>
        <translation>%1 پاسخ نمی‌دهد: %2</translation>
    </message>
    <message>
        <source>Connected to %1.</source>
        <translation>به %1 وصل است.</translation>
    </message>
    <message>
        <source>The connection is lost: %1. It is tried again by itself. Jobs run on the gateway: a pulled cable does not end them.</source>
        <translation>اتصال قطع شد: %1. خودش دوباره تلاش می‌کند. کارها روی درگاه اجرا می‌شوند: کشیدن کابل آن‌ها را پایان نمی‌دهد.</translation>
    </message>
    <message>
        <source>A driver card on a bench</source>
        <translation>کارت راه‌انداز روی میز کار</translation>
    </message>
    <message>
        <source>One node on this computer&apos;s CAN interface, without gateway and machine file: its motors&apos; currents, jogged and measured, and its switches.</source>
        <translation>یک گره روی رابط CAN این رایانه، بدون درگاه و پروندهٔ ماشین: جریان موتورها، حرکت دستی، اندازه‌گیری و کلیدهایش.</translation>
    </message>
    <message>
        <source>Open the card</source>
        <translation>باز کردن کارت</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ConsolePage</name>
    <message>
        <source>Send</source>
        <translation>فرستادن</translation>
    </message>
    <message>
        <source>Answers of the gateway</source>
        <translation>پاسخ‌های درگاه</translation>
    </message>
    <message>
        <source>Lines you send and the gateway&apos;s answers appear here.</source>
        <translation>خط‌هایی که می‌فرستید و پاسخ‌های درگاه اینجا دیده می‌شوند.</translation>
    </message>
    <message>
        <source>G-code or M-code, for example M114</source>
        <translation>G-code یا M-code، برای نمونه M114</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::DemoGateway</name>
    <message>
        <source>the demo machine has ended</source>
        <translation>ماشین نمایشی پایان یافت</translation>
    </message>
    <message>
        <source>the program kinebusd was not found: install the package kinebus-daemon</source>
        <translation>برنامهٔ kinebusd پیدا نشد: بستهٔ kinebus-daemon را نصب کنید</translation>
    </message>
    <message>
        <source>the demo machine does not answer</source>
        <translation>ماشین نمایشی پاسخ نمی‌دهد</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::EventsModel</name>
    <message>
        <source>Done</source>
        <translation>انجام شد</translation>
    </message>
    <message>
        <source>The check of the job found a problem</source>
        <translation>بررسی کار اشکالی یافت</translation>
    </message>
    <message>
        <source>Message</source>
        <translation>پیام</translation>
    </message>
    <message>
        <source>node %1</source>
        <translation>گره %1</translation>
    </message>
    <message>
        <source>line %1</source>
        <translation>خط %1</translation>
    </message>
    <message>
        <source>Control of the machine</source>
        <translation>کنترل ماشین</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::FilamentKeys</name>
    <message>
        <source>Unload</source>
        <translation>بیرون کشیدن</translation>
    </message>
    <message>
        <source>Load</source>
        <translation>بارگذاری</translation>
    </message>
    <message>
        <source>Purge</source>
        <translation>تخلیه</translation>
    </message>
    <message>
        <source>%1 mm of filament</source>
        <translation>%1 mm فیلامنت</translation>
    </message>
    <message>
        <source>[pause] of the machine file says no length</source>
        <translation>[pause] در پروندهٔ ماشین طولی نمی‌گوید</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::Gamepad</name>
    <message>
        <source>gamepad</source>
        <translation>دستهٔ بازی</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::GatewayFinder</name>
    <message>
        <source>USB %1 · serial number %2</source>
        <translation>USB %1 · شمارهٔ سریال %2</translation>
    </message>
    <message>
        <source>Gateway on this computer</source>
        <translation>درگاه روی این رایانه</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatPanel</name>
    <message>
        <source>Measure a heater</source>
        <translation>اندازه‌گیری گرم‌کن</translation>
    </message>
    <message>
        <source>Its node heats it with full power for half of the way, switches it off and follows its curve. What it finds makes the heater reach its target fast, without going beyond it.</source>
        <translation>گرهٔ آن تا نیمهٔ راه با توان کامل گرمش می‌کند، خاموشش می‌کند و منحنی‌اش را دنبال می‌کند. با آنچه می‌یابد گرم‌کن زود و بی‌آنکه از هدف بگذرد به آن می‌رسد.</translation>
    </message>
    <message>
        <source>Heater</source>
        <translation>گرم‌کن</translation>
    </message>
    <message>
        <source>Good at</source>
        <translation>دمای کار</translation>
    </message>
    <message>
        <source>Temperature that it shall be good at</source>
        <translation>دمایی که باید در آن خوب کار کند</translation>
    </message>
    <message>
        <source>It is at</source>
        <translation>دمای اکنون</translation>
    </message>
    <message>
        <source>Measure</source>
        <translation>اندازه‌گیری</translation>
    </message>
    <message>
        <source>End</source>
        <translation>پایان</translation>
    </message>
    <message>
        <source>Ends the measurement: the heater is switched off and stays as it was</source>
        <translation>اندازه‌گیری را پایان می‌دهد: گرم‌کن خاموش می‌شود و همان‌گونه که بود می‌ماند</translation>
    </message>
    <message>
        <source>Temperature while it is measured</source>
        <translation>دما هنگام اندازه‌گیری</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>پیشرفت</translation>
    </message>
    <message>
        <source>Power, by the machine file</source>
        <translation>توان (از پروندهٔ ماشین)</translation>
    </message>
    <message>
        <source>%1 W</source>
        <translation>%1 W</translation>
    </message>
    <message>
        <source>Heat capacity</source>
        <translation>ظرفیت حرارتی</translation>
    </message>
    <message>
        <source>%1 J/K</source>
        <translation>%1 J/K</translation>
    </message>
    <message>
        <source>Loss</source>
        <translation>اتلاف</translation>
    </message>
    <message>
        <source>%1 W/K</source>
        <translation>%1 W/K</translation>
    </message>
    <message>
        <source>Dead time</source>
        <translation>زمان مرده</translation>
    </message>
    <message>
        <source>%1 s</source>
        <translation>%1 s</translation>
    </message>
    <message>
        <source>Lag</source>
        <translation>تأخیر</translation>
    </message>
    <message>
        <source>What was found</source>
        <translation>آنچه یافته شد</translation>
    </message>
    <message>
        <source>The measurement begins</source>
        <translation>اندازه‌گیری آغاز می‌شود</translation>
    </message>
    <message>
        <source>It heats with full power</source>
        <translation>با توان کامل گرم می‌شود</translation>
    </message>
    <message>
        <source>The power is off, its curve is followed</source>
        <translation>توان قطع است، منحنی‌اش دنبال می‌شود</translation>
    </message>
    <message>
        <source>The node works out what it has seen, and stores it</source>
        <translation>گره آنچه را دیده است حساب و ذخیره می‌کند</translation>
    </message>
    <message>
        <source>Measured, to be good at %1</source>
        <translation>برای کار در %1 اندازه‌گیری شد</translation>
    </message>
    <message>
        <source>The heater&apos;s node works by these values from now on, and keeps them without power.</source>
        <translation>گرهٔ گرم‌کن از این پس با این مقدارها کار می‌کند و بی‌برق هم نگهشان می‌دارد.</translation>
    </message>
    <message>
        <source>The heater&apos;s node works by these values from now on. %1</source>
        <translation>گرهٔ گرم‌کن از این پس با این مقدارها کار می‌کند. %1</translation>
    </message>
    <message>
        <source>Not measured</source>
        <translation>اندازه‌گیری نشد</translation>
    </message>
    <message>
        <source>Not measured since the gateway was started</source>
        <translation>از آغاز کار درگاه اندازه‌گیری نشده است</translation>
    </message>
    <message>
        <source>This machine has no heater</source>
        <translation>این ماشین گرم‌کن ندارد</translation>
    </message>
    <message>
        <source>%1 gets full power until it is half of the way to %2. It is hot then, and the machine does nothing else for some minutes. Its fan should blow as it does in a print.</source>
        <translation>%1 تا نیمهٔ راه به %2 توان کامل می‌گیرد. داغ می‌شود و ماشین چند دقیقه کار دیگری نمی‌کند. فن آن باید مانند هنگام چاپ بوزد.</translation>
    </message>
    <message>
        <source>Not now</source>
        <translation>اکنون نه</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatPlot</name>
    <message>
        <source>Temperatures</source>
        <translation>دماها</translation>
    </message>
    <message>
        <source>Time that is shown</source>
        <translation>زمانی که نمایش داده می‌شود</translation>
    </message>
    <message>
        <source>10 minutes</source>
        <translation>۱۰ دقیقه</translation>
    </message>
    <message>
        <source>Whole job</source>
        <translation>کل کار</translation>
    </message>
    <message>
        <source>Temperatures, power and fans</source>
        <translation>دماها، توان و فن‌ها</translation>
    </message>
    <message>
        <source>begin</source>
        <translation>آغاز</translation>
    </message>
    <message>
        <source>10 minutes ago</source>
        <translation>۱۰ دقیقه پیش</translation>
    </message>
    <message>
        <source>now</source>
        <translation>اکنون</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatersCard</name>
    <message>
        <source>Heat</source>
        <translation>دما</translation>
    </message>
    <message>
        <source>Heat for a material</source>
        <translation>گرم کردن برای یک ماده</translation>
    </message>
    <message>
        <source>Temperatures by the machine file: tables [material.NAME]</source>
        <translation>دماها از پروندهٔ ماشین: جدول‌های [material.NAME]</translation>
    </message>
    <message>
        <source>Bed</source>
        <translation>بستر</translation>
    </message>
    <message>
        <source>Chamber</source>
        <translation>محفظه</translation>
    </message>
    <message>
        <source>Nozzle %1</source>
        <translation>نازل %1</translation>
    </message>
    <message>
        <source>Nozzle</source>
        <translation>نازل</translation>
    </message>
    <message>
        <source>Target temperature of the bed</source>
        <translation>دمای هدف بستر</translation>
    </message>
    <message>
        <source>Target temperature of the chamber</source>
        <translation>دمای هدف محفظه</translation>
    </message>
    <message>
        <source>Target temperature of nozzle %1</source>
        <translation>دمای هدف نازل %1</translation>
    </message>
    <message>
        <source>Target temperature of the nozzle</source>
        <translation>دمای هدف نازل</translation>
    </message>
    <message>
        <source>off</source>
        <translation>خاموش</translation>
    </message>
    <message>
        <source>%1, in use</source>
        <translation>%1، در حال استفاده</translation>
    </message>
    <message>
        <source>Fan %1</source>
        <translation>فن %1</translation>
    </message>
    <message>
        <source>Fan</source>
        <translation>فن</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobPanel</name>
    <message>
        <source>Interrupted: clear the stop, then resume goes on from its place.</source>
        <translation>نیمه‌کاره: توقف را رفع کنید، سپس ادامه از همان جا پی می‌گیرد.</translation>
    </message>
    <message>
        <source>Interrupted: clear the alarm, then resume goes on from its place.</source>
        <translation>نیمه‌کاره: هشدار را رفع کنید، سپس ادامه از همان جا پی می‌گیرد.</translation>
    </message>
    <message>
        <source>Interrupted: resume goes on from its place.</source>
        <translation>نیمه‌کاره: ادامه، از همان جا پی می‌گیرد.</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>پیشرفت</translation>
    </message>
    <message>
        <source>Elapsed</source>
        <translation>گذشته</translation>
    </message>
    <message>
        <source>Remaining</source>
        <translation>مانده</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>خط</translation>
    </message>
    <message>
        <source>Cancel the job</source>
        <translation>لغو کار</translation>
    </message>
    <message>
        <source>Cancel the job? What is printed stays on the bed.</source>
        <translation>کار لغو شود؟ آنچه چاپ شده روی بستر می‌ماند.</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>ادامه</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>سرعت</translation>
    </message>
    <message>
        <source>Feed override in percent</source>
        <translation>ضریب سرعت به درصد</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>ادامه</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>لغو</translation>
    </message>
    <message>
        <source>No job is running</source>
        <translation>کاری در حال اجرا نیست</translation>
    </message>
    <message>
        <source>Last known. What the job does now is unknown.</source>
        <translation>آخرین وضعیت دانسته: اکنونِ کار دانسته نیست.</translation>
    </message>
    <message>
        <source>Leave an object out</source>
        <translation>کنار گذاشتن یک جسم</translation>
    </message>
    <message>
        <source>Print no more of %1? It cannot be taken back.</source>
        <translation>%1 دیگر چاپ نشود؟ این کار برگشت‌پذیر نیست.</translation>
    </message>
    <message>
        <source>Set aside</source>
        <translation>کنار گذاشتن</translation>
    </message>
    <message>
        <source>The tool rises and parks: then jog, heat, extrude or change the filament. Resume goes on from the job&apos;s place.</source>
        <translation>ابزار بالا می‌رود و پارک می‌کند: سپس حرکت دستی، گرم کردن، اکستروژن یا تعویض فیلامنت ممکن است. ادامه، کار را از همان جا پیش می‌برد.</translation>
    </message>
    <message>
        <source>Finished.</source>
        <translation>پایان یافت.</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>لغو شد.</translation>
    </message>
    <message>
        <source>Not begun: the Jobs page says what is wrong.</source>
        <translation>آغاز نشد: صفحهٔ کارها می‌گوید مشکل چیست.</translation>
    </message>
    <message>
        <source>Ended by a stop.</source>
        <translation>با یک ایست پایان یافت.</translation>
    </message>
    <message>
        <source>Change the filament: load, purge, then resume.</source>
        <translation>فیلامنت را عوض کنید: بارگذاری، تخلیه، سپس ادامه.</translation>
    </message>
    <message>
        <source>Filament</source>
        <translation>فیلامنت</translation>
    </message>
    <message>
        <source>%1 m</source>
        <translation>%1 m</translation>
    </message>
    <message>
        <source>Clock error</source>
        <translation>خطای ساعت</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
    <message>
        <source>Bus load</source>
        <translation>بار گذرگاه</translation>
    </message>
    <message>
        <source>Least queue</source>
        <translation>کمترین صف</translation>
    </message>
    <message>
        <source>Slowed</source>
        <translation>کندشده</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobUpload</name>
    <message>
        <source>%1 cannot be read</source>
        <translation>%1 خوانده نمی‌شود</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobsModel</name>
    <message>
        <source>Job</source>
        <translation>کار</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>اندازه</translation>
    </message>
    <message>
        <source>Uploaded</source>
        <translation>زمان ارسال</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>بررسی</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>زمان</translation>
    </message>
    <message>
        <source>Last run</source>
        <translation>آخرین اجرا</translation>
    </message>
    <message>
        <source>Reading</source>
        <translation>در حال خواندن</translation>
    </message>
    <message>
        <source>Waiting for the gateway</source>
        <translation>در انتظار درگاه</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>ناموفق</translation>
    </message>
    <message>
        <source>Not checked</source>
        <translation>بررسی نشده</translation>
    </message>
    <message numerus="yes">
        <source>%Ln error(s)</source>
        <translation>
            <numerusform>%Ln خطا</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%Ln warning(s)</source>
        <translation>
            <numerusform>%Ln اخطار</numerusform>
        </translation>
    </message>
    <message>
        <source>Fine</source>
        <translation>بی‌اشکال</translation>
    </message>
    <message>
        <source>Never</source>
        <translation>هرگز</translation>
    </message>
    <message>
        <source>Running</source>
        <translation>در حال اجرا</translation>
    </message>
    <message>
        <source>Complete, %1</source>
        <translation>کامل، %1</translation>
    </message>
    <message>
        <source>Cancelled</source>
        <translation>لغو شد</translation>
    </message>
    <message>
        <source>Refused by the check</source>
        <translation>در بررسی رد شد</translation>
    </message>
    <message>
        <source>Stopped by an alarm</source>
        <translation>با هشدار ایستاد</translation>
    </message>
    <message>
        <source>Interrupted</source>
        <translation>نیمه‌کاره</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobsPage</name>
    <message>
        <source>Drop G-code files here to send them to the gateway</source>
        <translation>پرونده‌های G-code را برای فرستادن به درگاه اینجا رها کنید</translation>
    </message>
    <message>
        <source>Choose a file…</source>
        <translation>انتخاب پرونده…</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>آغاز</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>بررسی</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>نمایش</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>حذف</translation>
    </message>
    <message>
        <source>Jobs on the gateway</source>
        <translation>کارهای روی درگاه</translation>
    </message>
    <message>
        <source>What the check has found</source>
        <translation>یافته‌های بررسی</translation>
    </message>
    <message>
        <source>Lines of the job</source>
        <translation>خط‌های کار</translation>
    </message>
    <message>
        <source>Choose a finding: its line is shown here, its place in the scene.</source>
        <translation>یک یافته را برگزینید: خطش اینجا و جایش در صحنه نشان داده می‌شود.</translation>
    </message>
    <message>
        <source>Checking %1…</source>
        <translation>در حال بررسی %1…</translation>
    </message>
    <message numerus="yes">
        <source>%1: %Ln error(s). It will not start.</source>
        <translation>
            <numerusform>%1: %Ln خطا. آغاز نخواهد شد.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%1: it can be printed, with %Ln warning(s). It takes %2.</source>
        <translation>
            <numerusform>%1: با %Ln اخطار چاپ‌شدنی است. زمان: %2.</numerusform>
        </translation>
    </message>
    <message>
        <source>%1: nothing is wrong. It takes %2.</source>
        <translation>%1: اشکالی ندارد. زمان: %2.</translation>
    </message>
    <message>
        <source>The gateway checks a whole job against every limit before anything moves.</source>
        <translation>درگاه پیش از هر حرکت، کل کار را با همهٔ حد‌ها می‌سنجد.</translation>
    </message>
    <message>
        <source>%1 of %2 used</source>
        <translation>%1 از %2 پر است</translation>
    </message>
    <message>
        <source>Send G-code to the gateway</source>
        <translation>فرستادن G-code به درگاه</translation>
    </message>
    <message>
        <source>G-code (*.gcode *.ngc *.nc *.g *.gco)</source>
        <translation>G-code (*.gcode *.ngc *.nc *.g *.gco)</translation>
    </message>
    <message>
        <source>All files (*)</source>
        <translation>همهٔ پرونده‌ها (*)</translation>
    </message>
    <message>
        <source>Delete %1 from the gateway?</source>
        <translation>%1 از درگاه حذف شود؟</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>نگه داشتن</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JogPad</name>
    <message>
        <source>Jog</source>
        <translation>حرکت دستی</translation>
    </message>
    <message>
        <source>A click is a step; a button or key that is held moves until it is let go. Keys: arrows move X and Y, Page Up and Page Down move Z, A and D tilt, Q and W turn the table, 1 to 5 choose the step.</source>
        <translation>هر کلیک یک گام است؛ دکمه یا کلیدی که نگه داشته شود تا رها شدن حرکت می‌دهد. کلیدها: پیکان‌ها X و Y را، Page Up و Page Down محور Z را حرکت می‌دهند؛ A و D کج می‌کنند، Q و W میز را می‌چرخانند و ۱ تا ۵ گام را برمی‌گزینند.</translation>
    </message>
    <message>
        <source>Step, mm or °</source>
        <translation>گام، mm یا °</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>سرعت</translation>
    </message>
    <message>
        <source>mm/s</source>
        <translation>mm/s</translation>
    </message>
    <message>
        <source>Move by %1</source>
        <translation>حرکت با %1</translation>
    </message>
    <message>
        <source>It moves while it is deflected and its left shoulder key is held: left stick X and Y, right stick Z and C; a little is slow.</source>
        <translation>تا وقتی دسته خم است و کلید شانهٔ چپ نگه داشته شده حرکت می‌کند: اهرم چپ X و Y، اهرم راست Z و C؛ کمی خم کردن یعنی آهسته.</translation>
    </message>
    <message>
        <source>It moves while it is deflected, along one axis at a time; a little is slow.</source>
        <translation>تا وقتی خم است حرکت می‌کند، هر بار در راستای یک محور؛ کمی خم کردن یعنی آهسته.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JogPage</name>
    <message>
        <source>Jog</source>
        <translation>حرکت دستی</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>ماشین</translation>
    </message>
    <message>
        <source>Home</source>
        <translation>خانه‌یابی</translation>
    </message>
    <message>
        <source>Wakes the nodes and brings all carriages to their switches</source>
        <translation>گره‌ها را بیدار می‌کند و همهٔ حامل‌ها را به کلیدهایشان می‌رساند</translation>
    </message>
    <message>
        <source>Bed reference</source>
        <translation>مرجع بستر</translation>
    </message>
    <message>
        <source>Goes to where every job begins</source>
        <translation>به جایی می‌رود که هر کار از آن آغاز می‌شود</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>مکث</translation>
    </message>
    <message>
        <source>Clear stop</source>
        <translation>رفع توقف</translation>
    </message>
    <message>
        <source>Motors off</source>
        <translation>خاموش کردن موتورها</translation>
    </message>
    <message>
        <source>Positions are lost: the machine must be homed again</source>
        <translation>موقعیت‌ها از دست می‌روند: ماشین باید دوباره خانه‌یابی شود</translation>
    </message>
    <message>
        <source>Work offsets</source>
        <translation>مبدأهای کاری</translation>
    </message>
    <message>
        <source>Coordinate system</source>
        <translation>دستگاه مختصات</translation>
    </message>
    <message>
        <source>Zero here</source>
        <translation>اینجا صفر</translation>
    </message>
    <message>
        <source>The tool&apos;s position becomes the zero of this system</source>
        <translation>موقعیت ابزار صفر این دستگاه می‌شود</translation>
    </message>
    <message>
        <source>Set</source>
        <translation>تنظیم</translation>
    </message>
    <message>
        <source>The values above become the zero of this system</source>
        <translation>مقدارهای بالا صفر این دستگاه می‌شوند</translation>
    </message>
    <message>
        <source>Active: %1, zero at %2</source>
        <translation>فعال: %1، صفر در %2</translation>
    </message>
    <message>
        <source>Zeros of the work coordinates</source>
        <translation>صفرهای مختصات کاری</translation>
    </message>
    <message>
        <source>Pin out</source>
        <translation>پین بیرون</translation>
    </message>
    <message>
        <source>Pin in</source>
        <translation>پین داخل</translation>
    </message>
    <message>
        <source>Self test</source>
        <translation>خودآزمایی</translation>
    </message>
    <message>
        <source>The pin goes out and in by itself, until it is told something else</source>
        <translation>پین تا دستور دیگر خودبه‌خود بیرون و داخل می‌رود</translation>
    </message>
    <message>
        <source>End alarm</source>
        <translation>پایان هشدار</translation>
    </message>
    <message>
        <source>The probe forgets its alarm, and the pin goes in</source>
        <translation>پروب هشدارش را فراموش می‌کند و پین داخل می‌رود</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is out</source>
        <translation>پین پروب بیرون است</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is in</source>
        <translation>پین پروب داخل است</translation>
    </message>
    <message>
        <source>The probe&apos;s pin moves</source>
        <translation>پین پروب حرکت می‌کند</translation>
    </message>
    <message>
        <source>The probe tests itself</source>
        <translation>پروب خودش را می‌آزماید</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is not where it should be</source>
        <translation>پین پروب جایی که باید باشد نیست</translation>
    </message>
    <message>
        <source>Filament</source>
        <translation>فیلامنت</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MachineFileEditor</name>
    <message>
        <source>Read again</source>
        <translation>خواندن دوباره</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>واگرد</translation>
    </message>
    <message>
        <source>Save on the gateway</source>
        <translation>ذخیره روی درگاه</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>پروندهٔ ماشین</translation>
    </message>
    <message>
        <source>What is wrong in the machine file</source>
        <translation>اشکال‌های پروندهٔ ماشین</translation>
    </message>
    <message>
        <source>Saved. The gateway uses it from its next start.</source>
        <translation>ذخیره شد. درگاه از راه‌اندازی بعدی آن را به کار می‌برد.</translation>
    </message>
    <message>
        <source>The built-in machine file</source>
        <translation>پروندهٔ ماشین درون‌ساخت</translation>
    </message>
    <message>
        <source>Not read yet</source>
        <translation>هنوز خوانده نشده</translation>
    </message>
    <message>
        <source>cannot be changed from here</source>
        <translation>از اینجا تغییرپذیر نیست</translation>
    </message>
    <message>
        <source>newer than what the gateway runs with</source>
        <translation>تازه‌تر از آنچه درگاه به کار می‌برد</translation>
    </message>
    <message>
        <source>The machine file says what the machine is: kinematics, axes, limits, nodes.</source>
        <translation>پروندهٔ ماشین می‌گوید ماشین چیست: سینماتیک، محورها، حد‌ها، گره‌ها.</translation>
    </message>
    <message>
        <source>Checking…</source>
        <translation>در حال بررسی…</translation>
    </message>
    <message>
        <source>The file is right.</source>
        <translation>پرونده درست است.</translation>
    </message>
    <message numerus="yes">
        <source>%Ln mistake(s): it cannot be saved.</source>
        <translation>
            <numerusform>%Ln اشتباه: ذخیره نمی‌شود.</numerusform>
        </translation>
    </message>
    <message>
        <source>Restart the gateway</source>
        <translation>آغاز دوبارهٔ درگاه</translation>
    </message>
    <message>
        <source>It begins anew with the file as it is saved, and keeps positions</source>
        <translation>با پروندهٔ ذخیره‌شده از نو آغاز می‌شود و موقعیت‌ها را نگه می‌دارد</translation>
    </message>
    <message>
        <source>What you have changed here is not saved. Read the gateway&apos;s file over it?</source>
        <translation>تغییرات شما اینجا ذخیره نشده است. پروندهٔ درگاه روی آن خوانده شود؟</translation>
    </message>
    <message>
        <source>Keep my changes</source>
        <translation>نگه داشتن تغییرات من</translation>
    </message>
    <message>
        <source>The gateway begins anew.</source>
        <translation>درگاه از نو آغاز می‌شود.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MachinePage</name>
    <message>
        <source>Machine</source>
        <translation>ماشین</translation>
    </message>
    <message>
        <source>Axes and nodes</source>
        <translation>محورها و گره‌ها</translation>
    </message>
    <message>
        <source>Bus and time</source>
        <translation>گذرگاه و زمان</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>پروندهٔ ماشین</translation>
    </message>
    <message>
        <source>Axes</source>
        <translation>محورها</translation>
    </message>
    <message>
        <source>Nodes</source>
        <translation>گره‌ها</translation>
    </message>
    <message>
        <source>Bus load</source>
        <translation>بار گذرگاه</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
    <message>
        <source>Largest clock error</source>
        <translation>بیشترین خطای ساعت</translation>
    </message>
    <message>
        <source>Emptiest queue</source>
        <translation>خالی‌ترین صف</translation>
    </message>
    <message>
        <source>Path rate</source>
        <translation>نرخ مسیر</translation>
    </message>
    <message>
        <source>Frames sent</source>
        <translation>قاب‌های فرستاده</translation>
    </message>
    <message>
        <source>Frames received</source>
        <translation>قاب‌های دریافتی</translation>
    </message>
    <message>
        <source>Segments sent</source>
        <translation>پاره‌های فرستاده</translation>
    </message>
    <message>
        <source>Sequence errors</source>
        <translation>خطاهای ترتیب</translation>
    </message>
    <message>
        <source>Underruns</source>
        <translation>خالی شدن صف</translation>
    </message>
    <message>
        <source>Unreadable frames</source>
        <translation>قاب‌های ناخوانا</translation>
    </message>
    <message>
        <source>Frames of strangers</source>
        <translation>قاب‌های بیگانه</translation>
    </message>
    <message>
        <source>Slowed for the bus</source>
        <translation>کندشده برای گذرگاه</translation>
    </message>
    <message>
        <source>Held for planning</source>
        <translation>نگه‌داشته برای برنامه‌ریزی</translation>
    </message>
    <message>
        <source>Not connected.</source>
        <translation>وصل نیست.</translation>
    </message>
    <message>
        <source>%1 · kinematics %2 · %3 axes on %4 nodes · bus %5</source>
        <translation>%1 · سینماتیک %2 · %3 محور روی %4 گره · گذرگاه %5</translation>
    </message>
    <message>
        <source>Motors</source>
        <translation>موتورها</translation>
    </message>
    <message>
        <source>Heaters</source>
        <translation>گرم‌کن‌ها</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MainWindow</name>
    <message>
        <source>Gateways</source>
        <translation>درگاه‌ها</translation>
    </message>
    <message>
        <source>View</source>
        <translation>نما</translation>
    </message>
    <message>
        <source>Jobs</source>
        <translation>کارها</translation>
    </message>
    <message>
        <source>Jog</source>
        <translation>حرکت دستی</translation>
    </message>
    <message>
        <source>Console</source>
        <translation>کنسول</translation>
    </message>
    <message>
        <source>Alarms</source>
        <translation>هشدارها</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>ماشین</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>موقعیت</translation>
    </message>
    <message>
        <source>Job</source>
        <translation>کار</translation>
    </message>
    <message>
        <source>Close the demo</source>
        <translation>بستن نمایشی</translation>
    </message>
    <message>
        <source>The demo machine ends with this window, and its job with it.</source>
        <translation>ماشین نمایشی با این پنجره پایان می‌یابد و کار آن نیز.</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>بستن</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>ادامه</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MotorsPanel</name>
    <message>
        <source>Motors</source>
        <translation>موتورها</translation>
    </message>
    <message>
        <source>Motor</source>
        <translation>موتور</translation>
    </message>
    <message>
        <source>Run current</source>
        <translation>جریان حرکت</translation>
    </message>
    <message>
        <source>Hold current</source>
        <translation>جریان نگهداری</translation>
    </message>
    <message>
        <source>Set currents</source>
        <translation>تنظیم جریان‌ها</translation>
    </message>
    <message>
        <source>Counts when the machine next stands still, and until the gateway is started anew</source>
        <translation>از ایست بعدی ماشین معتبر است، تا وقتی درگاه از نو آغاز شود</translation>
    </message>
    <message>
        <source>Jog this motor alone</source>
        <translation>حرکت دستی فقط این موتور</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>گام</translation>
    </message>
    <message>
        <source>Jog back</source>
        <translation>دستی: عقب</translation>
    </message>
    <message>
        <source>Jog on</source>
        <translation>دستی: جلو</translation>
    </message>
    <message>
        <source>Measure the motor</source>
        <translation>اندازه‌گیری موتور</translation>
    </message>
    <message>
        <source>The node measures resistance, inductance and the encoder&apos;s offset while the motor stands</source>
        <translation>گره هنگام ایست موتور مقاومت، القاوری و انحراف انکودر را اندازه می‌گیرد</translation>
    </message>
    <message>
        <source>Switches of node %1: %2</source>
        <translation>کلیدهای گره %1: %2</translation>
    </message>
    <message>
        <source>One node on a bench, without a machine file: stop the gateway, then the page Gateways, or %1 on the computer with the bus, shows, sets, jogs and measures its motors.</source>
        <translation>یک گره روی میز کار، بدون پروندهٔ ماشین: درگاه را متوقف کنید؛ صفحهٔ درگاه‌ها یا %1 روی رایانه‌ای که گذرگاه به آن وصل است، موتورهایش را نشان می‌دهد، تنظیم می‌کند، دستی حرکت می‌دهد و اندازه می‌گیرد.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::NodesModel</name>
    <message>
        <source>Node</source>
        <translation>گره</translation>
    </message>
    <message>
        <source>State</source>
        <translation>وضعیت</translation>
    </message>
    <message>
        <source>Clock error</source>
        <translation>خطای ساعت</translation>
    </message>
    <message>
        <source>Queue</source>
        <translation>صف</translation>
    </message>
    <message>
        <source>Inputs</source>
        <translation>ورودی‌ها</translation>
    </message>
    <message>
        <source>Segments sent</source>
        <translation>پاره‌های فرستاده</translation>
    </message>
    <message>
        <source>Faults</source>
        <translation>خطاها</translation>
    </message>
    <message>
        <source>Not there</source>
        <translation>حاضر نیست</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>متوقف</translation>
    </message>
    <message>
        <source>Starting</source>
        <translation>در حال راه‌اندازی</translation>
    </message>
    <message>
        <source>Idle</source>
        <translation>بیکار</translation>
    </message>
    <message>
        <source>Operational</source>
        <translation>آمادهٔ کار</translation>
    </message>
    <message>
        <source>Operational, not in time</source>
        <translation>آمادهٔ کار، ناهم‌زمان</translation>
    </message>
    <message>
        <source>Waiting</source>
        <translation>در انتظار</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::Notice</name>
    <message>
        <source>Close</source>
        <translation>بستن</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::NumberField</name>
    <message>
        <source>%1 is not within %2 to %3</source>
        <translation>%1 میان %2 و %3 نیست</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::PlotWidget</name>
    <message>
        <source>%1 s ago</source>
        <translation>%1 ثانیه پیش</translation>
    </message>
    <message>
        <source>now</source>
        <translation>اکنون</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::PositionPanel</name>
    <message>
        <source>Carriages and axes</source>
        <translation>حامل‌ها و محورها</translation>
    </message>
    <message>
        <source>By its scale %1 (%2)</source>
        <translation>با خط‌کش آن %1 (%2)</translation>
    </message>
    <message>
        <source>By its scale: read at rest</source>
        <translation>خط‌کش آن در حال سکون خوانده می‌شود</translation>
    </message>
    <message>
        <source>Tool over the part</source>
        <translation>ابزار نسبت به قطعه</translation>
    </message>
    <message>
        <source>Position not known yet</source>
        <translation>موقعیت هنوز معلوم نیست</translation>
    </message>
    <message>
        <source>Last known position</source>
        <translation>آخرین موقعیت دانسته</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ProblemsModel</name>
    <message>
        <source>Error</source>
        <translation>خطا</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>اخطار</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>نوع</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>خط</translation>
    </message>
    <message>
        <source>What is wrong</source>
        <translation>اشکال</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::SocketLink</name>
    <message>
        <source>the gateway closed the connection</source>
        <translation>درگاه اتصال را بست</translation>
    </message>
    <message>
        <source>on this computer</source>
        <translation>روی این رایانه</translation>
    </message>
    <message>
        <source>no gateway runs there</source>
        <translation>آنجا درگاهی اجرا نمی‌شود</translation>
    </message>
    <message>
        <source>this user may not use the gateway&apos;s socket</source>
        <translation>این کاربر اجازهٔ سوکت درگاه را ندارد</translation>
    </message>
    <message>
        <source>the connection on this computer has failed</source>
        <translation>اتصال روی این رایانه شکست خورد</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::SpaceMouse</name>
    <message>
        <source>3D mouse</source>
        <translation>ماوس سه‌بعدی</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::TopBar</name>
    <message>
        <source>STOP</source>
        <translation>ایست</translation>
    </message>
    <message>
        <source>Stops all motion at once, on the path (Ctrl+.)</source>
        <translation>همهٔ حرکت‌ها را بی‌درنگ روی مسیر می‌ایستاند (Ctrl+.)</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>زبان</translation>
    </message>
    <message>
        <source>Light or dark</source>
        <translation>روشن یا تیره</translation>
    </message>
    <message>
        <source>Take control</source>
        <translation>گرفتن کنترل</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>کنترل در دست %1 است</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>وصل نیست</translation>
    </message>
    <message>
        <source>Connecting</source>
        <translation>در حال اتصال</translation>
    </message>
    <message>
        <source>Connection lost</source>
        <translation>اتصال قطع شد</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>اتصال</translation>
    </message>
    <message>
        <source>%1 · %2</source>
        <translation>%1 · %2</translation>
    </message>
    <message>
        <source>Choose a gateway</source>
        <translation>یک درگاه برگزینید</translation>
    </message>
    <message>
        <source>No news for %1. Last known: %2</source>
        <translation>%1 است که خبری نیست. آخرین وضعیت: %2</translation>
    </message>
    <message>
        <source>No news for %1. Last known: %2, %3 at %4</source>
        <translation>%1 است که خبری نیست. آخرین وضعیت: %2، %3 در %4</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::TuningPlot</name>
    <message>
        <source>The curve is drawn here while a heater is measured.</source>
        <translation>هنگام اندازه‌گیری یک گرم‌کن، منحنی‌اش اینجا کشیده می‌شود.</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>هدف</translation>
    </message>
    <message>
        <source>full power</source>
        <translation>توان کامل</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::UsbLink</name>
    <message>
        <source>the USB cable was pulled</source>
        <translation>کابل USB کشیده شد</translation>
    </message>
    <message>
        <source>the gateway is not plugged in</source>
        <translation>درگاه وصل نیست</translation>
    </message>
    <message>
        <source>this user may not use the USB device: install the udev rule of the package</source>
        <translation>این کاربر اجازهٔ دستگاه USB را ندارد: قاعدهٔ udev بسته را نصب کنید</translation>
    </message>
    <message>
        <source>another program uses the gateway&apos;s USB link</source>
        <translation>برنامهٔ دیگری پیوند USB درگاه را به کار می‌برد</translation>
    </message>
    <message>
        <source>the USB link does not start</source>
        <translation>پیوند USB آغاز نمی‌شود</translation>
    </message>
    <message>
        <source>USB %1</source>
        <translation>USB %1</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ViewPage</name>
    <message>
        <source>The 3D scene cannot be shown: %1</source>
        <translation>صحنهٔ سه‌بعدی نشان‌دادنی نیست: %1</translation>
    </message>
    <message>
        <source>Scene: machine and tool path</source>
        <translation>صحنه: ماشین و مسیر ابزار</translation>
    </message>
    <message>
        <source>Show the layers up to here</source>
        <translation>نمایش لایه‌ها تا اینجا</translation>
    </message>
    <message>
        <source>Colour by</source>
        <translation>رنگ بر پایهٔ</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>سرعت پیشروی</translation>
    </message>
    <message>
        <source>Layer</source>
        <translation>لایه</translation>
    </message>
    <message>
        <source>Limit margin</source>
        <translation>فاصله تا حد</translation>
    </message>
    <message>
        <source>Colour of the tool path</source>
        <translation>رنگ مسیر ابزار</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>ماشین</translation>
    </message>
    <message>
        <source>Reach of the tool</source>
        <translation>دسترس ابزار</translation>
    </message>
    <message>
        <source>Moves without extrusion</source>
        <translation>حرکت‌های بدون اکستروژن</translation>
    </message>
    <message>
        <source>What is not printed yet</source>
        <translation>آنچه هنوز چاپ نشده</translation>
    </message>
    <message>
        <source>From a corner</source>
        <translation>از گوشه</translation>
    </message>
    <message>
        <source>From above</source>
        <translation>از بالا</translation>
    </message>
    <message>
        <source>From the front</source>
        <translation>از روبه‌رو</translation>
    </message>
    <message>
        <source>Whole machine (M)</source>
        <translation>کل ماشین (M)</translation>
    </message>
    <message>
        <source>The part alone (F)</source>
        <translation>تنها قطعه (F)</translation>
    </message>
    <message>
        <source>%1 mm/s</source>
        <translation>%1 mm/s</translation>
    </message>
    <message>
        <source>at a limit</source>
        <translation>در مرز</translation>
    </message>
    <message>
        <source>free</source>
        <translation>آزاد</translation>
    </message>
    <message>
        <source>%1 cannot be shown: %2</source>
        <translation>%1 نشان‌دادنی نیست: %2</translation>
    </message>
    <message>
        <source>Reading %1</source>
        <translation>خواندن %1</translation>
    </message>
    <message>
        <source>%1 · %2 lines · %3 layers · %4 m of path</source>
        <translation>%1 · %2 خط · %3 لایه · %4 متر مسیر</translation>
    </message>
    <message numerus="yes">
        <source>%Ln line(s) are refused and not drawn</source>
        <translation>
            <numerusform>%Ln خط پذیرفته نشد و رسم نشد</numerusform>
        </translation>
    </message>
    <message>
        <source>No job is shown. Choose one on the Jobs page.</source>
        <translation>کاری نشان داده نمی‌شود. از صفحهٔ «کارها» یکی را برگزینید.</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>As a body</source>
        <translation>همچون جسم</translation>
    </message>
    <message>
        <source>Show the layers from here on</source>
        <translation>نمایش لایه‌ها از این‌جا به بعد</translation>
    </message>
    <message>
        <source>Show the topmost layer&apos;s moves up to here</source>
        <translation>نمایش حرکت‌های بالاترین لایه تا این‌جا</translation>
    </message>
    <message>
        <source>Kind of line</source>
        <translation>نوع خط</translation>
    </message>
    <message>
        <source>other</source>
        <translation>دیگر</translation>
    </message>
    <message>
        <source>outer wall</source>
        <translation>دیوارهٔ بیرونی</translation>
    </message>
    <message>
        <source>inner wall</source>
        <translation>دیوارهٔ درونی</translation>
    </message>
    <message>
        <source>infill</source>
        <translation>پُرکننده</translation>
    </message>
    <message>
        <source>top and bottom</source>
        <translation>رو و کف</translation>
    </message>
    <message>
        <source>bridge</source>
        <translation>پل</translation>
    </message>
    <message>
        <source>support</source>
        <translation>تکیه‌گاه</translation>
    </message>
    <message>
        <source>skirt and brim</source>
        <translation>دامن و لبه</translation>
    </message>
    <message>
        <source>gap</source>
        <translation>شکاف</translation>
    </message>
    <message>
        <source>Where the tool went in the last five minutes</source>
        <translation>راهی که ابزار در پنج دقیقهٔ گذشته رفته است</translation>
    </message>
    <message>
        <source>%1, by the encoders: at most %2 mm from where it should have been</source>
        <translation>%1، از روی انکودرها: حداکثر %2 mm دور از جایی که باید می‌بود</translation>
    </message>
    <message>
        <source>%1, as commanded: no axis has an encoder</source>
        <translation>%1، بنا بر فرمان: هیچ محوری انکودر ندارد</translation>
    </message>
</context>
</TS>
