<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="tr" sourcelanguage="en">
<context>
    <name>ConsoleHints</name>
    <message>
        <source>traverse</source>
        <translation>hızlı konumlama</translation>
    </message>
    <message>
        <source>straight line at feed</source>
        <translation>ilerlemeyle doğru çizgi</translation>
    </message>
    <message>
        <source>arc, clockwise</source>
        <translation>yay, saat yönünde</translation>
    </message>
    <message>
        <source>arc, counter-clockwise</source>
        <translation>yay, saat yönünün tersine</translation>
    </message>
    <message>
        <source>home, or go to the bed reference</source>
        <translation>referansa git ya da tabla referansına git</translation>
    </message>
    <message>
        <source>first work coordinate system</source>
        <translation>birinci iş koordinat sistemi</translation>
    </message>
    <message>
        <source>second work coordinate system</source>
        <translation>ikinci iş koordinat sistemi</translation>
    </message>
    <message>
        <source>absolute positions</source>
        <translation>mutlak konumlar</translation>
    </message>
    <message>
        <source>relative positions</source>
        <translation>göreli konumlar</translation>
    </message>
    <message>
        <source>call this position so</source>
        <translation>bu konumu böyle adlandır</translation>
    </message>
    <message>
        <source>motors on</source>
        <translation>motorlar açık</translation>
    </message>
    <message>
        <source>motors off</source>
        <translation>motorlar kapalı</translation>
    </message>
    <message>
        <source>list the jobs</source>
        <translation>işleri listele</translation>
    </message>
    <message>
        <source>choose a job</source>
        <translation>iş seç</translation>
    </message>
    <message>
        <source>start or resume</source>
        <translation>başlat ya da sürdür</translation>
    </message>
    <message>
        <source>pause</source>
        <translation>duraklat</translation>
    </message>
    <message>
        <source>progress of the job</source>
        <translation>işin ilerlemesi</translation>
    </message>
    <message>
        <source>time of the job</source>
        <translation>işin süresi</translation>
    </message>
    <message>
        <source>extruder absolute</source>
        <translation>ekstruder mutlak</translation>
    </message>
    <message>
        <source>extruder relative</source>
        <translation>ekstruder göreli</translation>
    </message>
    <message>
        <source>heat the nozzle</source>
        <translation>nozulu ısıt</translation>
    </message>
    <message>
        <source>temperatures</source>
        <translation>sıcaklıklar</translation>
    </message>
    <message>
        <source>fan on</source>
        <translation>fan açık</translation>
    </message>
    <message>
        <source>fan off</source>
        <translation>fan kapalı</translation>
    </message>
    <message>
        <source>heat the nozzle and wait</source>
        <translation>nozulu ısıt ve bekle</translation>
    </message>
    <message>
        <source>emergency stop</source>
        <translation>acil durdurma</translation>
    </message>
    <message>
        <source>position</source>
        <translation>konum</translation>
    </message>
    <message>
        <source>name and capabilities</source>
        <translation>ad ve yetenekler</translation>
    </message>
    <message>
        <source>switches</source>
        <translation>anahtarlar</translation>
    </message>
    <message>
        <source>heat the bed</source>
        <translation>tablayı ısıt</translation>
    </message>
</context>
<context>
    <name>Desk</name>
    <message>
        <source>Demo machine</source>
        <translation>Deneme makinesi</translation>
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
        <translation>%1/sn</translation>
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
        <translation>yayın merkezi başlangıç noktası</translation>
    </message>
    <message>
        <source>the arc&apos;s end is %1 from the centre, its start %2 (they may differ by %3)</source>
        <translation>yayın sonu merkezden %1, başı %2 uzakta (en çok %3 fark olabilir)</translation>
    </message>
    <message>
        <source>an arc with R needs an end other than its start; a full circle needs I, J or K</source>
        <translation>R ile verilen yayın sonu başından ayrı olmalı; tam daire için I, J ya da K gerekir</translation>
    </message>
    <message>
        <source>R must not be 0</source>
        <translation>R 0 olamaz</translation>
    </message>
    <message>
        <source>the arc&apos;s ends are %1 apart, more than twice R (%2)</source>
        <translation>yayın uçları arası %1, R&apos;nin iki katından fazla (%2)</translation>
    </message>
    <message>
        <source>% stands alone in its line</source>
        <translation>% satırında tek başına durur</translation>
    </message>
    <message>
        <source>N needs a whole number from 0 to 4294967295</source>
        <translation>N, 0 ile 4294967295 arasında bir tam sayı ister</translation>
    </message>
    <message>
        <source>/ (block delete) must be the first character of the line</source>
        <translation>/ (blok atlama) satırın ilk karakteri olmalı</translation>
    </message>
    <message>
        <source>byte %1 is not G-code</source>
        <translation>%1 baytı G kodu değil</translation>
    </message>
    <message>
        <source>expected a letter before &apos;%1&apos;</source>
        <translation>&apos;%1&apos; karakterinden önce bir harf bekleniyordu</translation>
    </message>
    <message>
        <source>comments in ( ) cannot hold another (</source>
        <translation>( ) içindeki açıklamada başka ( olamaz</translation>
    </message>
    <message>
        <source>the comment needs a closing )</source>
        <translation>açıklamanın kapanan ) işareti eksik</translation>
    </message>
    <message>
        <source>expected = after the parameter</source>
        <translation>parametreden sonra = bekleniyordu</translation>
    </message>
    <message>
        <source>%1 cannot be used in a turned coordinate system (G10 R)</source>
        <translation>%1 döndürülmüş koordinat sisteminde (G10 R) kullanılamaz</translation>
    </message>
    <message>
        <source>G30 means a probe to printers and a stored position to mills: keep one with G30.1 before it, or use G53 G0 with coordinates</source>
        <translation>G30 yazıcılarda prob, frezelerde kayıtlı konum demektir: önce G30.1 ile bir konum kaydedin, ya da koordinatlarla G53 G0 kullanın</translation>
    </message>
    <message>
        <source>%1 needs G49 and G69: machine coordinates do not turn with the part</source>
        <translation>%1, G49 ve G69 ister: makine koordinatları parçayla dönmez</translation>
    </message>
    <message>
        <source>G10 needs L1, L2, L10, L11 or L20 (or no L: retract)</source>
        <translation>G10 L1, L2, L10, L11 ya da L20 ister (L&apos;siz: geri çekme)</translation>
    </message>
    <message>
        <source>G10 L%1 needs the tool P</source>
        <translation>G10 L%1 takımı (P) ister</translation>
    </message>
    <message>
        <source>too many tools are changed by G10 (1000 at most)</source>
        <translation>G10 çok fazla takımı değiştiriyor (en çok 1000)</translation>
    </message>
    <message>
        <source>@ and ^ cannot stand beside X and Y</source>
        <translation>@ ve ^, X ve Y ile birlikte yazılamaz</translation>
    </message>
    <message>
        <source>@ and ^ cannot stand beside %1</source>
        <translation>@ ve ^, %1 ile birlikte yazılamaz</translation>
    </message>
    <message>
        <source>@ and ^ need the plane of X and Y (G17)</source>
        <translation>@ ve ^, X ve Y düzlemini (G17) ister</translation>
    </message>
    <message>
        <source>under G91 @ and ^ cannot start at the zero point, where there is no angle</source>
        <translation>G91 altında @ ve ^, açısı olmayan sıfır noktasından başlayamaz</translation>
    </message>
    <message>
        <source>constant surface speed (G96) needs a spindle, which this machine does not have</source>
        <translation>sabit kesme hızı (G96) iş mili ister, bu makinede yok</translation>
    </message>
    <message>
        <source>G96 needs S, the surface speed</source>
        <translation>G96, kesme hızını (S) ister</translation>
    </message>
    <message>
        <source>the highest speed D of G96 must be greater than 0</source>
        <translation>G96&apos;nın en yüksek devri (D) 0&apos;dan büyük olmalıdır</translation>
    </message>
    <message>
        <source>%1 stands twice in the line</source>
        <translation>%1 satırda iki kez geçiyor</translation>
    </message>
    <message>
        <source>too many assignments in one line (32 at most)</source>
        <translation>bir satırda çok fazla atama var (en çok 32)</translation>
    </message>
    <message>
        <source>a checksum needs a line number (N) at the line&apos;s beginning</source>
        <translation>sağlama toplamı için satır başında satır numarası (N) gerekir</translation>
    </message>
    <message>
        <source>a checksum is a number from 0 to 255</source>
        <translation>sağlama toplamı 0 ile 255 arasında bir sayıdır</translation>
    </message>
    <message>
        <source>nothing can follow the checksum</source>
        <translation>sağlama toplamından sonra bir şey gelemez</translation>
    </message>
    <message>
        <source>the checksum is %1, not %2</source>
        <translation>sağlama toplamı %1, %2 değil</translation>
    </message>
    <message>
        <source>G needs a number</source>
        <translation>G bir sayı ister</translation>
    </message>
    <message>
        <source>M needs a number</source>
        <translation>M bir sayı ister</translation>
    </message>
    <message>
        <source>%1 is too large (10^9 at most)</source>
        <translation>%1 çok büyük (en çok 10^9)</translation>
    </message>
    <message>
        <source>%1 stands twice in the line (first at column %2)</source>
        <translation>%1 satırda iki kez geçiyor (ilki %2. sütunda)</translation>
    </message>
    <message>
        <source>G codes are 0 to 999.9 with one decimal place at most</source>
        <translation>G kodları 0 ile 999.9 arasında, en çok bir ondalıklıdır</translation>
    </message>
    <message>
        <source>%1 and %2 (column %3) are of one modal group: only one can stand in a line</source>
        <translation>%1 ile %2 (sütun %3) aynı kip grubundan: satırda yalnız biri olabilir</translation>
    </message>
    <message>
        <source>M codes are whole numbers</source>
        <translation>M kodları tam sayıdır</translation>
    </message>
    <message>
        <source>%1 and M%2 (column %3) exclude one another: only one can stand in a line</source>
        <translation>%1 ile M%2 (sütun %3) birlikte olamaz: satırda yalnız biri olabilir</translation>
    </message>
    <message>
        <source>too many M codes in one line (8 at most)</source>
        <translation>bir satırda çok fazla M kodu var (en çok 8)</translation>
    </message>
    <message>
        <source>G68.3 is not supported: use G68.2 with I J K</source>
        <translation>G68.3 desteklenmiyor: I J K ile G68.2 kullanın</translation>
    </message>
    <message>
        <source>feed for each turn (G95) needs a spindle, which this machine does not have</source>
        <translation>devir başına ilerleme (G95) iş mili ister, bu makinede yok</translation>
    </message>
    <message>
        <source>M3 turns a spindle, which this machine does not have</source>
        <translation>M3 iş milini döndürür, bu makinede yok</translation>
    </message>
    <message>
        <source>M4 turns a spindle, which this machine does not have</source>
        <translation>M4 iş milini döndürür, bu makinede yok</translation>
    </message>
    <message>
        <source>%1 is unknown</source>
        <translation>%1 bilinmiyor</translation>
    </message>
    <message>
        <source>this is binary G-code (.bgcode): have the slicer write it as text</source>
        <translation>bu ikili G kodu (.bgcode): dilimleyiciye metin olarak yazdırın</translation>
    </message>
    <message>
        <source>this is a ZIP archive (3MF or similar): unpack the G-code in it first</source>
        <translation>bu bir ZIP arşivi (3MF veya benzeri): önce içindeki G kodunu çıkarın</translation>
    </message>
    <message>
        <source>this is a gzip archive: unpack it first</source>
        <translation>bu bir gzip arşivi: önce açın</translation>
    </message>
    <message>
        <source>this text is UTF-16: save it as UTF-8</source>
        <translation>bu metin UTF-16: UTF-8 olarak kaydedin</translation>
    </message>
    <message>
        <source>%1 more lines are refused for reasons named above</source>
        <translation>%1 satır daha yukarıda belirtilen nedenlerle kabul edilmiyor</translation>
    </message>
    <message>
        <source>the line is longer than 4096 bytes</source>
        <translation>satır 4096 bayttan uzun</translation>
    </message>
    <message>
        <source>%1 has no effect on this machine</source>
        <translation>%1 bu makinede etkisiz</translation>
    </message>
    <message>
        <source>there is no shaper %1; known are none, zv, mzv, zvd, zvdd, zvddd, ei, ei2 (2hump_ei), ei3 (3hump_ei)</source>
        <translation>%1 adında bir biçimlendirici yok; bilinenler none, zv, mzv, zvd, zvdd, zvddd, ei, ei2 (2hump_ei), ei3 (3hump_ei)</translation>
    </message>
    <message>
        <source>a shaper for %1 Hz; allowed are %2 to %3 Hz, or 0 for none</source>
        <translation>%1 Hz için biçimlendirici; izin verilen %2 ile %3 Hz arası, ya da kapatmak için 0</translation>
    </message>
    <message>
        <source>a shaper for a damping ratio of %1; allowed are 0 to %2</source>
        <translation>%1 sönüm oranı için biçimlendirici; izin verilen 0 ile %2 arası</translation>
    </message>
    <message>
        <source>%1 with %2 is not supported: X Y Z, F in Hz, D or S for the damping, P&quot;shaper&quot;</source>
        <translation>%1, %2 ile desteklenmiyor: X Y Z, Hz olarak F, sönüm için D ya da S, P&quot;biçimlendirici&quot;</translation>
    </message>
    <message>
        <source>%1 knows no %2: SHAPER_TYPE, SHAPER_FREQ and DAMPING_RATIO, with _X, _Y or _Z behind them</source>
        <translation>%1, %2 sözcüğünü bilmez: SHAPER_TYPE, SHAPER_FREQ ve DAMPING_RATIO, arkalarında _X, _Y ya da _Z ile</translation>
    </message>
    <message>
        <source>K%1 is on the scale of linear advance 1.0 (Marlin before 1.1.9), which says nothing in seconds: write K in s, 0 to %2, or leave it to advance_s in [pressure_advance]</source>
        <translation>K%1, linear advance 1.0 ölçeğindedir (1.1.9 öncesi Marlin) ve saniye olarak bir anlamı yoktur: K değerini s olarak, 0 ile %2 arasında yazın ya da [pressure_advance] içindeki advance_s değerine bırakın</translation>
    </message>
    <message>
        <source>a shaper without a frequency: neither the job nor [vibration] has said one</source>
        <translation>frekansı olmayan biçimlendirici: ne iş ne de [vibration] bir frekans söyledi</translation>
    </message>
    <message>
        <source>different shapers on a machine that turns or tilts the part: one shaper for X, Y and Z is needed</source>
        <translation>parçayı döndüren ya da eğen bir makinede farklı biçimlendiriciler: X, Y ve Z için tek biçimlendirici gerekir</translation>
    </message>
    <message>
        <source>%1 and %2 would both use the line&apos;s axis words: write them in two lines</source>
        <translation>%1 ile %2 satırın eksen sözcüklerini birlikte kullanır: iki satıra yazın</translation>
    </message>
    <message>
        <source>%1 can only be read</source>
        <translation>%1 yalnızca okunabilir</translation>
    </message>
    <message>
        <source>offsets cannot change in a tilted plane: end it with G69 first</source>
        <translation>eğik düzlemde ofset değiştirilemez: önce G69 ile bitirin</translation>
    </message>
    <message>
        <source>the offset is too large (10^9 at most)</source>
        <translation>ofset çok büyük (en çok 10^9)</translation>
    </message>
    <message>
        <source>too many named parameters (1000 at most)</source>
        <translation>çok fazla adlı parametre var (en çok 1000)</translation>
    </message>
    <message>
        <source>the machine has no axis %1; its axes are X Y Z A C and E</source>
        <translation>makinede %1 ekseni yok; eksenleri X Y Z A C ve E</translation>
    </message>
    <message>
        <source>%1 has no use in this line: no motion code is given or active</source>
        <translation>%1 bu satırda işe yaramaz: hareket kodu verilmemiş, etkin de değil</translation>
    </message>
    <message>
        <source>%1 has no use in this line</source>
        <translation>%1 bu satırda işe yaramaz</translation>
    </message>
    <message>
        <source>two codes of this line would both use %1: write them in two lines</source>
        <translation>bu satırın iki kodu da %1 kullanır: iki satıra yazın</translation>
    </message>
    <message>
        <source>%1 needs a number</source>
        <translation>%1 bir sayı ister</translation>
    </message>
    <message>
        <source>tool H%1 has no length here: gcode.tool_length_mm of the machine file gives it one, or G10 L1 P%1 Z in the job</source>
        <translation>H%1 takımının burada boyu yok: makine dosyasının gcode.tool_length_mm anahtarı ya da işte G10 L1 P%1 Z ona bir boy verir</translation>
    </message>
    <message>
        <source>%1 must be a whole number from %2 to %3</source>
        <translation>%1, %2 ile %3 arasında bir tam sayı olmalı</translation>
    </message>
    <message>
        <source>the expression is nested too deep (40 levels at most)</source>
        <translation>ifade çok derin (en çok 40 düzey)</translation>
    </message>
    <message>
        <source>expected a number, #parameter, [expression] or function</source>
        <translation>sayı, #parametre, [ifade] ya da işlev bekleniyordu</translation>
    </message>
    <message>
        <source>expected an operator or ]</source>
        <translation>işleç ya da ] bekleniyordu</translation>
    </message>
    <message>
        <source>the expression has no finite value</source>
        <translation>ifadenin sonlu bir değeri yok</translation>
    </message>
    <message>
        <source>division by zero</source>
        <translation>sıfıra bölme</translation>
    </message>
    <message>
        <source>the operation has no finite result</source>
        <translation>işlemin sonlu bir sonucu yok</translation>
    </message>
    <message>
        <source>%1 is not defined for this value</source>
        <translation>%1 bu değer için tanımsız</translation>
    </message>
    <message>
        <source>atan is written atan[y]/[x]</source>
        <translation>atan şöyle yazılır: atan[y]/[x]</translation>
    </message>
    <message>
        <source>atan[0]/[0] is not defined</source>
        <translation>atan[0]/[0] tanımsız</translation>
    </message>
    <message>
        <source>exists is written exists[#&lt;name&gt;]</source>
        <translation>exists şöyle yazılır: exists[#&lt;ad&gt;]</translation>
    </message>
    <message>
        <source>expected ]</source>
        <translation>] bekleniyordu</translation>
    </message>
    <message>
        <source>a parameter&apos;s name is made of letters, digits, _ and -</source>
        <translation>parametre adı harf, rakam, _ ve - içerir</translation>
    </message>
    <message>
        <source>the parameter&apos;s name is too long (64 letters at most)</source>
        <translation>parametre adı çok uzun (en çok 64 harf)</translation>
    </message>
    <message>
        <source>the parameter&apos;s name needs a closing &gt;</source>
        <translation>parametre adının kapanan &gt; işareti eksik</translation>
    </message>
    <message>
        <source>the parameter&apos;s name is empty</source>
        <translation>parametre adı boş</translation>
    </message>
    <message>
        <source>#&lt;%1&gt; has no value yet</source>
        <translation>#&lt;%1&gt; henüz değer almadı</translation>
    </message>
    <message>
        <source>the text holds a NUL byte: this is not a G-code file</source>
        <translation>metinde NUL baytı var: bu bir G kodu dosyası değil</translation>
    </message>
    <message>
        <source>%1 needs a speed S</source>
        <translation>%1 bir S hızı ister</translation>
    </message>
    <message>
        <source>the spindle&apos;s speed S cannot be below 0</source>
        <translation>iş milinin hızı S 0&apos;dan küçük olamaz</translation>
    </message>
    <message>
        <source>the idle time of M%1 S has no effect on this machine</source>
        <translation>M%1 S bekleme süresi bu makinede etkisiz</translation>
    </message>
    <message>
        <source>%1 takes S or R, not both</source>
        <translation>%1 S ya da R alır, ikisini birden değil</translation>
    </message>
    <message>
        <source>%1 needs a temperature S or R</source>
        <translation>%1 bir S ya da R sıcaklığı ister</translation>
    </message>
    <message>
        <source>%1 needs a temperature S</source>
        <translation>%1 bir S sıcaklığı ister</translation>
    </message>
    <message>
        <source>a target temperature cannot be below 0 deg C</source>
        <translation>hedef sıcaklık 0 °C altında olamaz</translation>
    </message>
    <message>
        <source>the fan&apos;s speed S is 0 to 255</source>
        <translation>fanın hızı S 0 ile 255 arasındadır</translation>
    </message>
    <message>
        <source>a limit must be greater than 0</source>
        <translation>sınır 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>%1 needs at least one axis word</source>
        <translation>%1 en az bir eksen sözcüğü ister</translation>
    </message>
    <message>
        <source>an acceleration must be greater than 0</source>
        <translation>ivme 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>M205 (jerk, junction deviation) has no effect: corners are blended within the tolerance of G64 P</source>
        <translation>M205 (silkinme, kavşak sapması) etkisiz: köşeler G64 P toleransı içinde yuvarlanır</translation>
    </message>
    <message>
        <source>M206 is not supported: write G10 L2 P0 with the values of the other sign</source>
        <translation>M206 desteklenmiyor: G10 L2 P0 yazın, değerler ters işaretli</translation>
    </message>
    <message>
        <source>M665 is not supported: write the geometry under [kinematics] in the machine file</source>
        <translation>M665 desteklenmiyor: geometriyi makine dosyasında [kinematics] altına yazın</translation>
    </message>
    <message>
        <source>M666 is not supported: write offset_mm of [joint.NAME.calibration] in the machine file</source>
        <translation>M666 desteklenmiyor: makine dosyasında [joint.NAME.calibration] altına offset_mm yazın</translation>
    </message>
    <message>
        <source>M92 has no effect: mm_per_turn, full_steps_per_turn and microsteps of [joint.NAME] in the machine file say how far a step goes</source>
        <translation>M92 etkisiz: bir adımın ne kadar gittiğini makine dosyasındaki [joint.NAME] altında mm_per_turn, full_steps_per_turn ve microsteps söyler</translation>
    </message>
    <message>
        <source>%1 has no effect: max_c of [heater.NAME] in the machine file says what a job may ask for</source>
        <translation>%1 etkisiz: bir işin ne isteyebileceğini makine dosyasındaki [heater.NAME] altında max_c söyler</translation>
    </message>
    <message>
        <source>%1 has no effect: min_extrude_c of [thermal] in the machine file says below what nothing is fed</source>
        <translation>%1 etkisiz: hangi sıcaklığın altında besleme yapılmayacağını makine dosyasındaki [thermal] altında min_extrude_c söyler</translation>
    </message>
    <message>
        <source>%1 has no effect: sensor of [heater.NAME] in the machine file says what a heater is measured by</source>
        <translation>%1 etkisiz: bir ısıtıcının hangi algılayıcıyla ölçüldüğünü makine dosyasındaki [heater.NAME] altında sensor söyler</translation>
    </message>
    <message>
        <source>%1 has no effect: a heater&apos;s node measures its model: kinebus tune NAME, or M303</source>
        <translation>%1 etkisiz: ısıtıcının modelini düğümü ölçer: kinebus tune NAME ya da M303</translation>
    </message>
    <message>
        <source>%1 has no effect: a heater&apos;s control belongs to its node and to [heater.NAME] in the machine file</source>
        <translation>%1 etkisiz: ısıtıcının kontrolü düğümünün ve makine dosyasındaki [heater.NAME] tablosunun işidir</translation>
    </message>
    <message>
        <source>the machine has one tool, T0; where T1 and T2 turned axes, write A and C</source>
        <translation>makinenin tek takımı var, T0; T1 ve T2 eksen döndürüyorsa A ve C yazın</translation>
    </message>
    <message>
        <source>the retraction&apos;s length cannot be negative</source>
        <translation>geri çekme uzunluğu eksi olamaz</translation>
    </message>
    <message>
        <source>F must be greater than 0</source>
        <translation>F 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>the retraction&apos;s lift cannot be negative</source>
        <translation>geri çekmedeki kaldırma eksi olamaz</translation>
    </message>
    <message>
        <source>%1 needs a percentage S</source>
        <translation>%1 bir S yüzdesi ister</translation>
    </message>
    <message>
        <source>the percentage of %1 is above 0 and at most 1000</source>
        <translation>%1 yüzdesi 0&apos;dan büyük, en çok 1000 olur</translation>
    </message>
    <message>
        <source>%1 needs the name of a stored job</source>
        <translation>%1 kayıtlı bir işin adını ister</translation>
    </message>
    <message>
        <source>M26 needs a byte position S</source>
        <translation>M26 bir S bayt konumu ister</translation>
    </message>
    <message>
        <source>the machine has no such tool: the last is T%1</source>
        <translation>makinede böyle bir takım yok: sonuncusu T%1</translation>
    </message>
    <message>
        <source>G4 takes P or S, not both</source>
        <translation>G4 P ya da S alır, ikisini birden değil</translation>
    </message>
    <message>
        <source>G4 cannot wait for a negative time</source>
        <translation>G4 eksi süre bekleyemez</translation>
    </message>
    <message>
        <source>the tolerance P of G64 cannot be negative</source>
        <translation>G64&apos;ün P toleransı eksi olamaz</translation>
    </message>
    <message>
        <source>the tolerance Q of G64 cannot be negative</source>
        <translation>G64&apos;ün Q toleransı eksi olamaz</translation>
    </message>
    <message>
        <source>in a tilted plane A and C turn only under G43.4, or by G53.1</source>
        <translation>eğik düzlemde A ve C yalnızca G43.4 altında ya da G53.1 ile döner</translation>
    </message>
    <message>
        <source>in inverse time mode (G93) every G1, G2 and G3 needs F</source>
        <translation>ters zaman kipinde (G93) her G1, G2 ve G3 F ister</translation>
    </message>
    <message>
        <source>no feed rate is set: this move needs F</source>
        <translation>ilerleme hızı verilmedi: bu hareket F ister</translation>
    </message>
    <message>
        <source>%1 and %2, or R</source>
        <translation>%1 ve %2 ya da R</translation>
    </message>
    <message>
        <source>%1 does not belong to the arc&apos;s plane: %2 needs %3</source>
        <translation>%1 yayın düzleminde değil: %2 %3 ister</translation>
    </message>
    <message>
        <source>%1 needs %2, not both</source>
        <translation>%1 %2 ister, ikisini birden değil</translation>
    </message>
    <message>
        <source>%1 needs %2</source>
        <translation>%1 %2 ister</translation>
    </message>
    <message>
        <source>with G90.1 an arc needs both %1 and %2</source>
        <translation>G90.1 ile yay hem %1 hem %2 ister</translation>
    </message>
    <message>
        <source>G53 needs G0 or G1, in this line or active</source>
        <translation>G53, bu satırda ya da etkin olarak G0 ya da G1 ister</translation>
    </message>
    <message>
        <source>G53 needs absolute distances (G90)</source>
        <translation>G53 mutlak uzaklık (G90) ister</translation>
    </message>
    <message>
        <source>%1 cannot change offsets in a tilted plane: end it with G69 first</source>
        <translation>%1 eğik düzlemde ofset değiştiremez: önce G69 ile bitirin</translation>
    </message>
    <message>
        <source>G10 needs P: 1 for G54 ... 9 for G59.3, 0 for the active one</source>
        <translation>G10 P ister: G54 için 1 ... G59.3 için 9, etkin olan için 0</translation>
    </message>
    <message>
        <source>G92 needs at least one axis word</source>
        <translation>G92 en az bir eksen sözcüğü ister</translation>
    </message>
    <message>
        <source>G43.4 and G68.2 need a tool of length 0: the machine file says where the tool&apos;s tip is</source>
        <translation>G43.4 ve G68.2 boyu 0 olan takım ister: takım ucunun yeri makine dosyasında</translation>
    </message>
    <message>
        <source>a tilted plane is active already: end it with G69 first</source>
        <translation>eğik düzlem zaten etkin: önce G69 ile bitirin</translation>
    </message>
    <message>
        <source>G68.2 uses the line&apos;s axis words: write the motion in another line</source>
        <translation>G68.2 satırın eksen sözcüklerini kullanır: hareketi başka satıra yazın</translation>
    </message>
    <message>
        <source>G53.1 needs a tilted plane (G68.2)</source>
        <translation>G53.1 eğik düzlem (G68.2) ister</translation>
    </message>
    <message>
        <source>no A within the machine&apos;s range makes the tool normal to the plane</source>
        <translation>makinenin aralığında takımı düzleme dik yapan A yok</translation>
    </message>
    <message>
        <source>G28 finds the home switches: name axes without a number</source>
        <translation>G28 referans anahtarlarını bulur: eksenleri sayısız yazın</translation>
    </message>
    <message>
        <source>this gateway runs with its built-in machine: start it with --machine FILE</source>
        <translation>bu ağ geçidi yerleşik makinesiyle çalışıyor: --machine DOSYA ile başlatın</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a %1 temperature (M104)</source>
        <translation>iş %1 sıcaklığını vermeden (M104) filament sürüyor</translation>
    </message>
    <message>
        <source>filament is fed with the %1 at %2; at least %3 is needed</source>
        <translation>%1 %2 iken filament sürülüyor; en az %3 gerekir</translation>
    </message>
    <message>
        <source>M112 stops the machine here</source>
        <translation>M112 makineyi burada durdurur</translation>
    </message>
    <message>
        <source>settings are kept in the machine file: M500 to M503 do nothing in a job</source>
        <translation>ayarlar makine dosyasında durur: M500 - M503 iş içinde bir şey yapmaz</translation>
    </message>
    <message>
        <source>hotend</source>
        <translation>nozul</translation>
    </message>
    <message>
        <source>bed</source>
        <translation>tabla</translation>
    </message>
    <message>
        <source>this machine has no %1 heater</source>
        <translation>bu makinede %1 ısıtıcısı yok</translation>
    </message>
    <message>
        <source>%1 temperature %2; allowed are 0 to %3</source>
        <translation>%1 sıcaklığı %2; izin verilen 0 - %3</translation>
    </message>
    <message>
        <source>%1 would wait forever: %2 is below the room&apos;s %3</source>
        <translation>%1 sonsuza dek beklerdi: %2, odanın %3 sıcaklığının altında</translation>
    </message>
    <message>
        <source>a job cannot manage stored jobs: M20 to M32 belong to a session</source>
        <translation>iş, kayıtlı işleri yönetemez: M20 - M32 oturumundur</translation>
    </message>
    <message>
        <source>shaped, this move asks %1 for %2 times its acceleration: lower the tool&apos;s acceleration, or take a shorter shaper</source>
        <translation>biçimlendirilince bu hareket %1 ekleminden ivmesinin %2 katını ister: takımın ivmesini düşürün ya da daha kısa bir biçimlendirici seçin</translation>
    </message>
    <message>
        <source>shaped, this move asks %1 for %2 times its speed: lower the tool&apos;s speed, or take a shorter shaper</source>
        <translation>biçimlendirilince bu hareket %1 ekleminden hızının %2 katını ister: takımın hızını düşürün ya da daha kısa bir biçimlendirici seçin</translation>
    </message>
    <message>
        <source>G28: %1</source>
        <translation>G28: %1</translation>
    </message>
    <message>
        <source>bed reference: %1</source>
        <translation>tabla referansı: %1</translation>
    </message>
    <message>
        <source>stored jobs are managed by the session: M20 to M32 stand alone in a line</source>
        <translation>kayıtlı işleri oturum yönetir: M20 - M32 satırda tek başına durur</translation>
    </message>
    <message>
        <source>a move needs numbers</source>
        <translation>hareket sayı ister</translation>
    </message>
    <message>
        <source>the move is too long to be checked</source>
        <translation>hareket kontrol edilemeyecek kadar uzun</translation>
    </message>
    <message>
        <source>centre, plane and target do not make an arc</source>
        <translation>merkez, düzlem ve hedef bir yay oluşturmuyor</translation>
    </message>
    <message>
        <source>the arc is too long to be checked</source>
        <translation>yay kontrol edilemeyecek kadar uzun</translation>
    </message>
    <message>
        <source>the arc turns too far to be checked</source>
        <translation>yay kontrol edilemeyecek kadar çok dönüyor</translation>
    </message>
    <message>
        <source>filament is fed before a %1 temperature is set</source>
        <translation>%1 sıcaklığı verilmeden filament sürülüyor</translation>
    </message>
    <message>
        <source>filament would be fed with the %1 at %2; at least %3 is needed</source>
        <translation>%1 %2 iken filament sürülürdü; en az %3 gerekir</translation>
    </message>
    <message>
        <source>this machine has no spindle</source>
        <translation>bu makinede iş mili yok</translation>
    </message>
    <message>
        <source>the spindle turns one way only: use M3</source>
        <translation>iş mili yalnız bir yöne döner: M3 kullanın</translation>
    </message>
    <message>
        <source>spindle speed %1 rpm; allowed are %2 to %3 rpm</source>
        <translation>iş mili hızı %1 dev/dk; izin verilen %2 - %3 dev/dk</translation>
    </message>
    <message>
        <source>no stored job has the name %1</source>
        <translation>%1 adında kayıtlı iş yok</translation>
    </message>
    <message>
        <source>the disk is full</source>
        <translation>disk dolu</translation>
    </message>
    <message>
        <source>%1 cannot be written: %2</source>
        <translation>%1 yazılamıyor: %2</translation>
    </message>
    <message>
        <source>a job&apos;s name has 1 to 200 bytes</source>
        <translation>iş adı 1 - 200 bayttır</translation>
    </message>
    <message>
        <source>a job&apos;s name does not begin with a dot</source>
        <translation>iş adı noktayla başlamaz</translation>
    </message>
    <message>
        <source>a job&apos;s name has no slashes and no control characters</source>
        <translation>iş adında bölü işareti ve kontrol karakteri olmaz</translation>
    </message>
    <message>
        <source>%1 cannot be written</source>
        <translation>%1 yazılamıyor</translation>
    </message>
    <message>
        <source>the job store&apos;s database: %1</source>
        <translation>iş deposunun veritabanı: %1</translation>
    </message>
    <message>
        <source>the job store&apos;s database cannot be opened</source>
        <translation>iş deposunun veritabanı açılamıyor</translation>
    </message>
    <message>
        <source>this upload is not open: begin it again, it goes on where it was</source>
        <translation>bu yükleme açık değil: yeniden başlatın, kaldığı yerden sürer</translation>
    </message>
    <message>
        <source>a job has at most %1 MiB</source>
        <translation>bir iş en çok %1 MiB olur</translation>
    </message>
    <message>
        <source>the store&apos;s quota of %1 MiB has no room for this job: delete others first</source>
        <translation>deponun %1 MiB kotasında bu işe yer yok: önce başkalarını silin</translation>
    </message>
    <message>
        <source>the disk has no room for this job: delete others first</source>
        <translation>diskte bu işe yer yok: önce başkalarını silin</translation>
    </message>
    <message>
        <source>an upload names the XXH3 of its job: 16 bytes</source>
        <translation>yükleme, işin XXH3 özetini bildirir: 16 bayt</translation>
    </message>
    <message>
        <source>another job has the name %1 already</source>
        <translation>%1 adında başka bir iş var</translation>
    </message>
    <message>
        <source>the next byte of this upload is %1, not %2</source>
        <translation>bu yüklemenin sıradaki baytı %1, %2 değil</translation>
    </message>
    <message>
        <source>more bytes than were announced</source>
        <translation>bildirilenden çok bayt geldi</translation>
    </message>
    <message>
        <source>%1 bytes of the job have not come yet</source>
        <translation>işin %1 baytı henüz gelmedi</translation>
    </message>
    <message>
        <source>the bytes that came are not those that were announced (XXH3 differs): send the job again</source>
        <translation>gelen baytlar bildirilenler değil (XXH3 farklı): işi yeniden gönderin</translation>
    </message>
    <message>
        <source>a travel&apos;s minimum is above its maximum</source>
        <translation>bir strokun alt sınırı üst sınırının üstünde</translation>
    </message>
    <message>
        <source>the table&apos;s pivot is not a number</source>
        <translation>tablanın dönme noktası sayı değil</translation>
    </message>
    <message>
        <source>radius_mm must be above 0</source>
        <translation>radius_mm 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>the arms must be longer than the delta radius</source>
        <translation>kollar delta yarıçapından uzun olmalı</translation>
    </message>
    <message>
        <source>a tower travel&apos;s minimum is above its maximum</source>
        <translation>bir kule strokunun alt sınırı üst sınırının üstünde</translation>
    </message>
    <message>
        <source>a pose limit&apos;s minimum is above its maximum</source>
        <translation>bir duruş sınırının altı üstünden büyük</translation>
    </message>
    <message>
        <source>the towers stand so that the delta is singular: two at one angle</source>
        <translation>kuleler deltayı tekil kılacak biçimde duruyor: ikisi aynı açıda</translation>
    </message>
    <message>
        <source>leg %1</source>
        <translation>bacak %1</translation>
    </message>
    <message>
        <source>%1: a coordinate is not a number</source>
        <translation>%1: bir koordinat sayı değil</translation>
    </message>
    <message>
        <source>%1: its length must be above 0 mm</source>
        <translation>%1: boyu 0 mm&apos;den büyük olmalı</translation>
    </message>
    <message>
        <source>%1: its rail has no direction</source>
        <translation>%1: rayının yönü yok</translation>
    </message>
    <message>
        <source>%1: its connector offset is not a number</source>
        <translation>%1: bağlantı ofseti sayı değil</translation>
    </message>
    <message>
        <source>%1: its travel&apos;s minimum is above the maximum</source>
        <translation>%1: strokunun alt sınırı üst sınırının üstünde</translation>
    </message>
    <message>
        <source>rotation_scale_mm must be above 0</source>
        <translation>rotation_scale_mm 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>max_condition must be 1 or more</source>
        <translation>max_condition 1 ya da daha büyük olmalı</translation>
    </message>
    <message>
        <source>no pose of the workspace can be reached: the legs are too short or the rails too far away</source>
        <translation>çalışma alanının hiçbir duruşuna erişilemiyor: bacaklar kısa ya da raylar uzak</translation>
    </message>
    <message>
        <source>the mechanism is singular or nearly so at every pose: the best condition number in the workspace is %1, the limit is %2; rails and attachments leave one motion of the platform without control (for instance attachments mirrored about the YZ plane)</source>
        <translation>mekanizma her duruşta tekil ya da neredeyse tekil: çalışma alanındaki en iyi koşul sayısı %1, sınır %2; raylar ve bağlantılar platformun bir hareketini kontrolsüz bırakıyor (örneğin YZ düzlemine göre yansımış bağlantılar)</translation>
    </message>
    <message>
        <source>rods, triangle, rails and rotation_scale_mm must be above 0 mm</source>
        <translation>çubuklar, üçgen, raylar ve rotation_scale_mm 0 mm&apos;den büyük olmalı</translation>
    </message>
    <message>
        <source>tool or table position is not a number</source>
        <translation>takım ya da tabla konumu sayı değil</translation>
    </message>
    <message>
        <source>a travel&apos;s or limit&apos;s minimum is above its maximum</source>
        <translation>bir strok ya da sınırın altı üstünden büyük</translation>
    </message>
    <message>
        <source>no pose of the workspace can be reached: the rods are too short for the rails&apos; distance</source>
        <translation>çalışma alanının hiçbir duruşuna erişilemiyor: çubuklar raylar arası uzaklığa göre kısa</translation>
    </message>
    <message>
        <source>the mechanism is singular or nearly so at every pose: the best condition number in the workspace is %1, the limit is %2; rods and triangle leave one motion of the spindle without control</source>
        <translation>mekanizma her duruşta tekil ya da neredeyse tekil: çalışma alanındaki en iyi koşul sayısı %1, sınır %2; çubuklar ve üçgen iş milinin bir hareketini kontrolsüz bırakıyor</translation>
    </message>
    <message>
        <source>%1: out of reach, the leg is %2 too short</source>
        <translation>%1: erişilemiyor, bacak %2 kısa</translation>
    </message>
    <message>
        <source>%1: would be %2 beyond its travel</source>
        <translation>%1: strokunun %2 dışında kalırdı</translation>
    </message>
    <message>
        <source>%1: the leg leans %2 too far from its rail</source>
        <translation>%1: bacak rayından %2 fazla eğiliyor</translation>
    </message>
    <message>
        <source>%1: leg, rail and platform come %2 too near to each other</source>
        <translation>%1: bacak, ray ve platform birbirine %2 fazla yaklaşıyor</translation>
    </message>
    <message>
        <source>%1 is %2 outside the workspace</source>
        <translation>%1 çalışma alanının %2 dışında</translation>
    </message>
    <message>
        <source>too near to a singular pose: condition number %1</source>
        <translation>tekil duruşa çok yakın: koşul sayısı %1</translation>
    </message>
    <message>
        <source>no pose fits these joint positions (%1 remain)</source>
        <translation>bu eklem konumlarına uyan duruş yok (%1 kalıyor)</translation>
    </message>
    <message>
        <source>unknown pose error</source>
        <translation>bilinmeyen duruş hatası</translation>
    </message>
    <message>
        <source>machine</source>
        <translation>makine</translation>
    </message>
    <message>
        <source>joint %1</source>
        <translation>eklem %1</translation>
    </message>
    <message>
        <source>over-current in a motor phase</source>
        <translation>bir motor fazında aşırı akım</translation>
    </message>
    <message>
        <source>check the motor and its cable for a short, then clear</source>
        <translation>motorda ve kablosunda kısa devre arayın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>a motor phase is shorted</source>
        <translation>bir motor fazı kısa devre</translation>
    </message>
    <message>
        <source>switch off, check the motor and its cable</source>
        <translation>kapatın, motoru ve kablosunu kontrol edin</translation>
    </message>
    <message>
        <source>supply voltage too high</source>
        <translation>besleme gerilimi çok yüksek</translation>
    </message>
    <message>
        <source>check the power supply</source>
        <translation>güç kaynağını kontrol edin</translation>
    </message>
    <message>
        <source>supply voltage too low</source>
        <translation>besleme gerilimi çok düşük</translation>
    </message>
    <message>
        <source>check the power supply and its wiring</source>
        <translation>güç kaynağını ve kablolarını kontrol edin</translation>
    </message>
    <message>
        <source>the node is too hot</source>
        <translation>düğüm çok sıcak</translation>
    </message>
    <message>
        <source>let it cool, check the fan</source>
        <translation>soğumasını bekleyin, fanı kontrol edin</translation>
    </message>
    <message>
        <source>a motor driver is too hot</source>
        <translation>bir motor sürücüsü çok sıcak</translation>
    </message>
    <message>
        <source>let it cool, lower the current, check the fan</source>
        <translation>soğumasını bekleyin, akımı düşürün, fanı kontrol edin</translation>
    </message>
    <message>
        <source>stored parameters are damaged</source>
        <translation>kayıtlı parametreler bozuk</translation>
    </message>
    <message>
        <source>bring up again: the gateway writes them anew</source>
        <translation>yeniden devreye alın: ağ geçidi onları yeniden yazar</translation>
    </message>
    <message>
        <source>internal software fault</source>
        <translation>iç yazılım hatası</translation>
    </message>
    <message>
        <source>switch the node off and on, report it</source>
        <translation>düğümü kapatıp açın, bildirin</translation>
    </message>
    <message>
        <source>encoder fault</source>
        <translation>kodlayıcı arızası</translation>
    </message>
    <message>
        <source>check the encoder&apos;s cable</source>
        <translation>kodlayıcının kablosunu kontrol edin</translation>
    </message>
    <message>
        <source>CAN frames were lost (overrun)</source>
        <translation>CAN çerçeveleri kayboldu (taşma)</translation>
    </message>
    <message>
        <source>check the load of the bus</source>
        <translation>veri yolunun yükünü kontrol edin</translation>
    </message>
    <message>
        <source>many CAN errors</source>
        <translation>çok sayıda CAN hatası</translation>
    </message>
    <message>
        <source>check cable and termination of the bus</source>
        <translation>veri yolunun kablosunu ve sonlandırmasını kontrol edin</translation>
    </message>
    <message>
        <source>the gateway&apos;s heartbeat or SYNC was missed</source>
        <translation>ağ geçidinin kalp atışı ya da SYNC iletisi gelmedi</translation>
    </message>
    <message>
        <source>check the gateway and the bus, then clear</source>
        <translation>ağ geçidini ve veri yolunu kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>recovered from bus-off</source>
        <translation>bus-off durumundan döndü</translation>
    </message>
    <message>
        <source>two nodes use the same id</source>
        <translation>iki düğüm aynı kimliği kullanıyor</translation>
    </message>
    <message>
        <source>give one of them another id (kinebus-node-id)</source>
        <translation>birine başka kimlik verin (kinebus-node-id)</translation>
    </message>
    <message>
        <source>an expected PDO did not arrive</source>
        <translation>beklenen bir PDO gelmedi</translation>
    </message>
    <message>
        <source>following error: the motor did not follow</source>
        <translation>izleme hatası: motor geri kaldı</translation>
    </message>
    <message>
        <source>look for an obstacle, home again</source>
        <translation>engel arayın, yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>a position limit was reached</source>
        <translation>konum sınırına gelindi</translation>
    </message>
    <message>
        <source>check the machine file&apos;s limits, home again</source>
        <translation>makine dosyasının sınırlarını kontrol edin, yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>clock synchronisation was lost</source>
        <translation>saat eşlemesi kayboldu</translation>
    </message>
    <message>
        <source>check the bus, then clear</source>
        <translation>veri yolunu kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>general fault</source>
        <translation>genel arıza</translation>
    </message>
    <message>
        <source>look at the node&apos;s state, then clear</source>
        <translation>düğümün durumuna bakın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>current fault</source>
        <translation>akım arızası</translation>
    </message>
    <message>
        <source>check motor and cable</source>
        <translation>motoru ve kabloyu kontrol edin</translation>
    </message>
    <message>
        <source>voltage fault</source>
        <translation>gerilim arızası</translation>
    </message>
    <message>
        <source>temperature fault</source>
        <translation>sıcaklık arızası</translation>
    </message>
    <message>
        <source>let it cool</source>
        <translation>soğumasını bekleyin</translation>
    </message>
    <message>
        <source>hardware fault</source>
        <translation>donanım arızası</translation>
    </message>
    <message>
        <source>switch the node off and on</source>
        <translation>düğümü kapatıp açın</translation>
    </message>
    <message>
        <source>software fault</source>
        <translation>yazılım arızası</translation>
    </message>
    <message>
        <source>fault of an additional module</source>
        <translation>ek modül arızası</translation>
    </message>
    <message>
        <source>monitoring fault</source>
        <translation>izleme arızası</translation>
    </message>
    <message>
        <source>additional function fault</source>
        <translation>ek işlev arızası</translation>
    </message>
    <message>
        <source>its queue ran low</source>
        <translation>kuyruğu azaldı</translation>
    </message>
    <message>
        <source>clear and resume; when it comes again, check the load of gateway and bus</source>
        <translation>alarmı kaldırıp sürdürün; yinelenirse ağ geçidi ve veri yolu yükünü kontrol edin</translation>
    </message>
    <message>
        <source>a record was lost</source>
        <translation>bir kayıt kayboldu</translation>
    </message>
    <message>
        <source>clear; when it comes again, check the bus for errors</source>
        <translation>alarmı kaldırın; yinelenirse veri yolunda hata arayın</translation>
    </message>
    <message>
        <source>its position is not the gateway&apos;s</source>
        <translation>konumu ağ geçidininkinden farklı</translation>
    </message>
    <message>
        <source>a record broke its limits</source>
        <translation>bir kayıt sınırlarını aştı</translation>
    </message>
    <message>
        <source>clear; check the machine file against the node&apos;s limits</source>
        <translation>alarmı kaldırın; makine dosyasını düğümün sınırlarıyla karşılaştırın</translation>
    </message>
    <message>
        <source>the emergency stop input</source>
        <translation>acil durdurma girişi</translation>
    </message>
    <message>
        <source>release the emergency stop when it is safe, then clear</source>
        <translation>güvenli olunca acil durdurmayı bırakın, sonra durdurmayı kaldırın</translation>
    </message>
    <message>
        <source>a limit switch</source>
        <translation>bir sınır anahtarı</translation>
    </message>
    <message>
        <source>move the carriage off the switch, then clear and home again</source>
        <translation>taşıyıcıyı anahtardan çekin, sonra alarmı kaldırıp yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>the gateway&apos;s heartbeat is missing</source>
        <translation>ağ geçidinin kalp atışı yok</translation>
    </message>
    <message>
        <source>SYNC is missing</source>
        <translation>SYNC yok</translation>
    </message>
    <message>
        <source>fault of a drive</source>
        <translation>bir sürücünün arızası</translation>
    </message>
    <message>
        <source>look at the drive&apos;s fault, then clear</source>
        <translation>sürücünün arızasına bakın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>its drives were switched off in motion</source>
        <translation>sürücüleri hareket hâlinde kapatıldı</translation>
    </message>
    <message>
        <source>clear and enable again</source>
        <translation>alarmı kaldırıp yeniden açın</translation>
    </message>
    <message>
        <source>another node asked for it</source>
        <translation>başka bir düğüm istedi</translation>
    </message>
    <message>
        <source>look at the other node&apos;s message</source>
        <translation>öbür düğümün iletisine bakın</translation>
    </message>
    <message>
        <source>unknown fault</source>
        <translation>bilinmeyen arıza</translation>
    </message>
    <message>
        <source>%1, axis B</source>
        <translation>%1, B ekseni</translation>
    </message>
    <message>
        <source>node %1: %2 (EMCY %3)</source>
        <translation>düğüm %1: %2 (EMCY %3)</translation>
    </message>
    <message>
        <source>check the node&apos;s power, its id (kinebus-node-id) and the bus cable, then bring up again</source>
        <translation>düğümün beslemesini, kimliğini (kinebus-node-id) ve veri yolu kablosunu kontrol edin, sonra yeniden devreye alın</translation>
    </message>
    <message>
        <source>connect the right node or update its firmware</source>
        <translation>doğru düğümü bağlayın ya da yazılımını güncelleyin</translation>
    </message>
    <message>
        <source>check the machine file against the node&apos;s limits</source>
        <translation>makine dosyasını düğümün sınırlarıyla karşılaştırın</translation>
    </message>
    <message>
        <source>look at the drive&apos;s fault, clear, then bring up again</source>
        <translation>sürücünün arızasına bakın, alarmı kaldırın, sonra yeniden devreye alın</translation>
    </message>
    <message>
        <source>switch one of the gateways off</source>
        <translation>ağ geçitlerinden birini kapatın</translation>
    </message>
    <message>
        <source>check the node&apos;s power and the bus cable, then clear and bring up again</source>
        <translation>düğümün beslemesini ve veri yolu kablosunu kontrol edin, sonra alarmı kaldırıp yeniden devreye alın</translation>
    </message>
    <message>
        <source>check the node&apos;s power, then clear, bring up and home again</source>
        <translation>düğümün beslemesini kontrol edin, sonra alarmı kaldırın, devreye alın ve yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>check the bus for errors, then clear</source>
        <translation>veri yolunda hata arayın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>check switch and wiring, then clear and home again</source>
        <translation>anahtarı ve kablosunu kontrol edin, sonra alarmı kaldırıp yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>check the switches of the carriages that went on, then clear and home again</source>
        <translation>ilerleyen taşıyıcıların anahtarlarını kontrol edin, sonra alarmı kaldırıp yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>check switches and home speeds, then clear and home again</source>
        <translation>anahtarları ve referansa gitme hızlarını kontrol edin, sonra alarmı kaldırıp yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>clear: positions are known, the job can be run again</source>
        <translation>alarmı kaldırın: konumlar biliniyor, iş yeniden çalıştırılabilir</translation>
    </message>
    <message>
        <source>clear; when it comes again, check the bus for lost frames</source>
        <translation>alarmı kaldırın; yinelenirse veri yolunda kayıp çerçeve arayın</translation>
    </message>
    <message>
        <source>check cable and termination of the bus, then clear and bring up again</source>
        <translation>veri yolunun kablosunu ve sonlandırmasını kontrol edin, sonra alarmı kaldırıp yeniden devreye alın</translation>
    </message>
    <message>
        <source>check heater and sensor, then clear; a job that is held goes on by resume</source>
        <translation>ısıtıcıyı ve algılayıcıyı kontrol edin, sonra alarmı kaldırın; duraklatılmış bir iş sürdürülünce devam eder</translation>
    </message>
    <message>
        <source>correct the job, then clear</source>
        <translation>işi düzeltin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>clear when the machine is safe</source>
        <translation>makine güvenli olunca durdurmayı kaldırın</translation>
    </message>
    <message>
        <source>switch the machine off and on, home again</source>
        <translation>makineyi kapatıp açın, yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>clear</source>
        <translation>alarmı kaldırma</translation>
    </message>
    <message>
        <source>listening for another gateway</source>
        <translation>başka ağ geçidi var mı dinleniyor</translation>
    </message>
    <message>
        <source>looking for the nodes</source>
        <translation>düğümler aranıyor</translation>
    </message>
    <message>
        <source>checking the nodes&apos; parameters</source>
        <translation>düğümlerin parametreleri kontrol ediliyor</translation>
    </message>
    <message>
        <source>starting the nodes</source>
        <translation>düğümler başlatılıyor</translation>
    </message>
    <message>
        <source>synchronising the clocks</source>
        <translation>saatler eşleniyor</translation>
    </message>
    <message>
        <source>equalising path time</source>
        <translation>yol zamanı eşitleniyor</translation>
    </message>
    <message>
        <source>enabling the drives</source>
        <translation>sürücüler açılıyor</translation>
    </message>
    <message>
        <source>another gateway speaks on this bus (SYNC, stamps or heartbeat of node 127)</source>
        <translation>bu veri yolunda başka bir ağ geçidi konuşuyor (SYNC, damga ya da düğüm 127&apos;nin kalp atışı)</translation>
    </message>
    <message>
        <source>vendor</source>
        <translation>üretici</translation>
    </message>
    <message>
        <source>product</source>
        <translation>ürün</translation>
    </message>
    <message>
        <source>revision</source>
        <translation>sürüm</translation>
    </message>
    <message>
        <source>serial number</source>
        <translation>seri numarası</translation>
    </message>
    <message>
        <source>node %1: %2 is %3, the machine file wants %4</source>
        <translation>düğüm %1: %2 %3, makine dosyası %4 istiyor</translation>
    </message>
    <message>
        <source>node %1 does not become operational</source>
        <translation>düğüm %1 çalışır duruma geçmiyor</translation>
    </message>
    <message>
        <source>node %1 does not synchronise its clock</source>
        <translation>düğüm %1 saatini eşlemiyor</translation>
    </message>
    <message>
        <source>the program of node %1 does not know smooth ramps: holds, resumes and changes of the override exceed the limits of jerk until it is updated</source>
        <translation>düğüm %1 programı yumuşak rampaları bilmiyor: güncellenene kadar duraklatma, sürdürme ve hız ayarı değişiklikleri silkinme sınırlarını aşar</translation>
    </message>
    <message>
        <source>node %1 keeps its stop latched: an emergency stop or limit switch is active</source>
        <translation>düğüm %1 durdurmayı bırakmıyor: acil durdurma ya da sınır anahtarı etkin</translation>
    </message>
    <message>
        <source>node %1: its drives do not enable (statuswords %2 and %3)</source>
        <translation>düğüm %1: sürücüleri açılmıyor (durum sözcükleri %2 ve %3)</translation>
    </message>
    <message>
        <source>node %1 did not come back after the return to its default parameters</source>
        <translation>düğüm %1 varsayılan parametrelere döndükten sonra geri gelmedi</translation>
    </message>
    <message>
        <source>node %1: its parameters have the fingerprint %2, the machine file&apos;s have %3, after all were written</source>
        <translation>düğüm %1: parametrelerinin özeti %2, makine dosyasınınki %3, hepsi yazıldığı hâlde</translation>
    </message>
    <message>
        <source>there is no interrupted job to %1</source>
        <translation>bunun için kesilmiş bir iş yok: %1</translation>
    </message>
    <message>
        <source>cannot %1 while the machine is %2</source>
        <translation>makine &quot;%2&quot; durumundayken yapılamaz: %1</translation>
    </message>
    <message>
        <source>%1: bring it up first</source>
        <translation>%1. Önce devreye alın</translation>
    </message>
    <message>
        <source>%1: home it first</source>
        <translation>%1. Önce referansa gönderin</translation>
    </message>
    <message>
        <source>%1: clear first</source>
        <translation>%1. Önce alarmı kaldırın</translation>
    </message>
    <message>
        <source>no pose fits the joints&apos; positions: %1</source>
        <translation>eklem konumlarına uyan duruş yok: %1</translation>
    </message>
    <message>
        <source>a jog needs numbers</source>
        <translation>manuel hareket sayı ister</translation>
    </message>
    <message>
        <source>a jog&apos;s speed is 0 or more</source>
        <translation>manuel hareket hızı 0 ya da büyüktür</translation>
    </message>
    <message>
        <source>a jog needs a distance</source>
        <translation>manuel hareket bir uzaklık ister</translation>
    </message>
    <message>
        <source>it is set to %1 C and filament is to be fed: at least %2 C is needed</source>
        <translation>%1 °C’ye ayarlı ve filament sürülecek: en az %2 °C gerekir</translation>
    </message>
    <message>
        <source>it has only %1 C and filament is to be fed: at least %2 C is needed</source>
        <translation>yalnızca %1 °C ve filament sürülecek: en az %2 °C gerekir</translation>
    </message>
    <message>
        <source>the %1 was switched off: nothing waits for it</source>
        <translation>%1 kapatıldı: hiçbir şey onu beklemiyor</translation>
    </message>
    <message>
        <source>the %1 is set to %2 C: set it to at least %3 C, then resume</source>
        <translation>%1 %2 °C’ye ayarlı: en az %3 °C’ye ayarlayın, sonra sürdürün</translation>
    </message>
    <message>
        <source>the job feeds filament, which needs at least %1 C: hold it first</source>
        <translation>iş filament sürüyor, bunun için en az %1 °C gerekir: önce işi bekletin</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a %1 temperature (M104): it runs only while the %1 is set to at least %2</source>
        <translation>iş %1 sıcaklığını vermeden (M104) filament sürüyor: ancak %1 en az %2’ye ayarlıyken yürür</translation>
    </message>
    <message>
        <source>the %1 is too cold to feed filament: %2 C</source>
        <translation>%1 filament sürmek için çok soğuk: %2 °C</translation>
    </message>
    <message>
        <source>the job cannot be read twice: it is checked before it runs</source>
        <translation>iş iki kez okunamıyor: çalışmadan önce kontrol edilir</translation>
    </message>
    <message>
        <source>cleared: resume brings the machine up again and goes on with the job</source>
        <translation>kaldırıldı: sürdürme makineyi yeniden devreye alır ve işe devam eder</translation>
    </message>
    <message>
        <source>cleared: bring the machine up again</source>
        <translation>kaldırıldı: makineyi yeniden devreye alın</translation>
    </message>
    <message>
        <source>a feed override is 0.01 to 5</source>
        <translation>hız ayarı 0.01 ile 5 arasındadır</translation>
    </message>
    <message>
        <source>the temperature must be 0 to %1 C</source>
        <translation>sıcaklık 0 ile %1 °C arasında olmalı</translation>
    </message>
    <message>
        <source>another gateway has begun to speak on this bus (COB-ID %1)</source>
        <translation>bu veri yolunda başka bir ağ geçidi konuşmaya başladı (COB-ID %1)</translation>
    </message>
    <message>
        <source>node %1 stays stopped by NMT</source>
        <translation>düğüm %1 NMT ile durdurulmuş kalıyor</translation>
    </message>
    <message>
        <source>%1 was taken out of operation by an NMT command of another device</source>
        <translation>%1 başka bir aygıtın NMT komutuyla çalışmadan çıkarıldı</translation>
    </message>
    <message>
        <source>%1: the drive of axis %2 was switched off by another device or a fault (statusword %3)</source>
        <translation>%1: eksen %2 sürücüsünü başka bir aygıt ya da bir arıza kapattı (statusword %3)</translation>
    </message>
    <message>
        <source>%1: axis %2 was set to the mode of operation %3 by another device</source>
        <translation>%1: başka bir aygıt eksen %2 için çalışma kipini %3 yaptı</translation>
    </message>
    <message>
        <source>%1: axis %2 moves, and not by this gateway</source>
        <translation>%1: eksen %2 hareket ediyor, ama bu ağ geçidi istemedi</translation>
    </message>
    <message>
        <source>node %1: another device has changed its parameters (fingerprint %2, the machine file&apos;s is %3): bringing up again writes them anew</source>
        <translation>düğüm %1: başka bir aygıt parametrelerini değiştirdi (parmak izi %2, makine dosyasınınki %3): yeniden devreye almak onları yeniden yazar</translation>
    </message>
    <message>
        <source>node %1, which the machine file does not name, has asked all to stop</source>
        <translation>makine dosyasında adı geçmeyen düğüm %1 herkesin durmasını istedi</translation>
    </message>
    <message>
        <source>another device speaks LSS, which gives nodes their ids (COB-ID %1)</source>
        <translation>başka bir aygıt, düğümlere kimlik veren LSS ile konuşuyor (COB-ID %1)</translation>
    </message>
    <message>
        <source>another device fills the bus with frames that nobody here uses (COB-ID %1)</source>
        <translation>başka bir aygıt veri yolunu burada kimsenin kullanmadığı çerçevelerle dolduruyor (COB-ID %1)</translation>
    </message>
    <message>
        <source>another device sends remote frames (COB-ID %1): nobody answers them</source>
        <translation>başka bir aygıt uzak çerçeveler gönderiyor (COB-ID %1): kimse yanıtlamaz</translation>
    </message>
    <message>
        <source>another device has sent node %1 a record of motion (COB-ID %2)</source>
        <translation>başka bir aygıt düğüm %1 için bir hareket kaydı gönderdi (COB-ID %2)</translation>
    </message>
    <message>
        <source>another device has sent all nodes an NMT command (%1)</source>
        <translation>başka bir aygıt tüm düğümlere bir NMT komutu gönderdi (%1)</translation>
    </message>
    <message>
        <source>another device has sent node %1 an NMT command (%2)</source>
        <translation>başka bir aygıt düğüm %1 için bir NMT komutu gönderdi (%2)</translation>
    </message>
    <message>
        <source>another device has sent node %1 a controlword or set point (COB-ID %2)</source>
        <translation>başka bir aygıt düğüm %1 için bir kontrol sözcüğü veya ayar değeri gönderdi (COB-ID %2)</translation>
    </message>
    <message>
        <source>another device writes object %2 of node %1 while the machine moves</source>
        <translation>makine hareket ederken başka bir aygıt düğüm %1 üzerindeki %2 nesnesine yazıyor</translation>
    </message>
    <message>
        <source>Another device has changed a node</source>
        <translation>Başka bir aygıt bir düğümü değiştirdi</translation>
    </message>
    <message>
        <source>look for another master or tool on the bus, then clear</source>
        <translation>veri yolunda başka bir yönetici ya da araç arayın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>clear: positions are read again; when it comes again, check the bus for errors</source>
        <translation>alarmı kaldırın: konumlar yeniden okunur; yinelenirse veri yolunda hata arayın</translation>
    </message>
    <message>
        <source>node %1</source>
        <translation>düğüm %1</translation>
    </message>
    <message>
        <source>%1 has restarted</source>
        <translation>%1 yeniden başladı</translation>
    </message>
    <message>
        <source>%1 is silent</source>
        <translation>%1 sessiz</translation>
    </message>
    <message>
        <source>%1 has lost the synchronisation of its clock</source>
        <translation>%1 saat eşlemesini yitirdi</translation>
    </message>
    <message>
        <source>%1 rests at another path time than the gateway: %2 us apart</source>
        <translation>%1 ağ geçidinden başka yol zamanında duruyor: %2 µs fark</translation>
    </message>
    <message>
        <source>too late: the machine is in use already</source>
        <translation>çok geç: makine zaten kullanılıyor</translation>
    </message>
    <message>
        <source>the interrupted job %1 is not there any more</source>
        <translation>kesilen iş %1 artık yok</translation>
    </message>
    <message>
        <source>the job %1 was interrupted: resume to go on with it, or cancel</source>
        <translation>%1 işi kesildi: sürdürün ya da iptal edin</translation>
    </message>
    <message>
        <source>the nodes have lost their positions: resume homes the machine and goes on</source>
        <translation>düğümler konumlarını yitirdi: sürdürme makineyi referansa gönderir ve devam eder</translation>
    </message>
    <message>
        <source>the job does not go on: %1</source>
        <translation>iş sürmüyor: %1</translation>
    </message>
    <message>
        <source>put right what is said, then resume</source>
        <translation>söyleneni düzeltin, sonra sürdürün</translation>
    </message>
    <message>
        <source>the job %1 is not the text that was interrupted: it does not go on</source>
        <translation>%1 işi kesilen metin değil: sürmüyor</translation>
    </message>
    <message>
        <source>run it from its beginning</source>
        <translation>baştan çalıştırın</translation>
    </message>
    <message>
        <source>the interrupted job cannot be read</source>
        <translation>kesilen iş okunamıyor</translation>
    </message>
    <message>
        <source>the job&apos;s place cannot be reached: %1</source>
        <translation>işin kaldığı yere erişilemiyor: %1</translation>
    </message>
    <message>
        <source>the tool was found %1 mm from its place: resume brings it back</source>
        <translation>takım yerinden %1 mm uzakta bulundu: sürdürme geri getirir</translation>
    </message>
    <message>
        <source>the job %1 goes on</source>
        <translation>%1 işi sürüyor</translation>
    </message>
    <message>
        <source>reading where the nodes stand</source>
        <translation>düğümlerin durduğu yer okunuyor</translation>
    </message>
    <message>
        <source>path time did not come to rest</source>
        <translation>yol zamanı durmadı</translation>
    </message>
    <message>
        <source>a node keeps its stop latched: is an emergency stop or a limit switch still active?</source>
        <translation>bir düğüm durdurmayı bırakmıyor: acil durdurma ya da sınır anahtarı hâlâ etkin mi?</translation>
    </message>
    <message>
        <source>a drive does not enable again: its fault is still there</source>
        <translation>bir sürücü yeniden açılmıyor: arızası sürüyor</translation>
    </message>
    <message>
        <source>a node does not know its position after homing</source>
        <translation>bir düğüm referansa gittikten sonra konumunu bilmiyor</translation>
    </message>
    <message>
        <source>homed</source>
        <translation>referansa gidildi</translation>
    </message>
    <message>
        <source>cancelled: positions are known</source>
        <translation>iptal edildi: konumlar biliniyor</translation>
    </message>
    <message>
        <source>the bus failed: %1</source>
        <translation>veri yolu çöktü: %1</translation>
    </message>
    <message>
        <source>error: %1</source>
        <translation>hata: %1</translation>
    </message>
    <message>
        <source>warning: %1</source>
        <translation>uyarı: %1</translation>
    </message>
    <message>
        <source>the job was not begun: it has %1 errors</source>
        <translation>iş başlatılmadı: %1 hatası var</translation>
    </message>
    <message>
        <source>correct the lines named, then run it again</source>
        <translation>belirtilen satırları düzeltin, sonra yeniden çalıştırın</translation>
    </message>
    <message>
        <source>M112 in the job</source>
        <translation>işte M112</translation>
    </message>
    <message>
        <source>move done</source>
        <translation>hareket bitti</translation>
    </message>
    <message>
        <source>all lines done: %1</source>
        <translation>bütün satırlar bitti: %1</translation>
    </message>
    <message>
        <source>job done: %1</source>
        <translation>iş bitti: %1</translation>
    </message>
    <message>
        <source>no file there</source>
        <translation>orada dosya yok</translation>
    </message>
    <message>
        <source>a readable TOML file</source>
        <translation>okunabilir bir TOML dosyası</translation>
    </message>
    <message>
        <source>more than 1 MiB</source>
        <translation>1 MiB&apos;tan fazla</translation>
    </message>
    <message>
        <source>a machine file, which is a few KiB long</source>
        <translation>birkaç KiB&apos;lık bir makine dosyası</translation>
    </message>
    <message>
        <source>a file that cannot be read</source>
        <translation>okunamayan bir dosya</translation>
    </message>
    <message>
        <source>a table</source>
        <translation>bir tablo</translation>
    </message>
    <message>
        <source>an array of %1</source>
        <translation>%1 öğeli dizi</translation>
    </message>
    <message>
        <source>a text</source>
        <translation>bir metin</translation>
    </message>
    <message>
        <source>G-code, a line each; line %1: %2</source>
        <translation>her satırda bir komut olan G kodu; satır %1: %2</translation>
    </message>
    <message>
        <source>another name than %1: upper and lower case are the same</source>
        <translation>%1 dışında bir ad: büyük ve küçük harf aynıdır</translation>
    </message>
    <message>
        <source>true or false</source>
        <translation>true ya da false</translation>
    </message>
    <message>
        <source>a number in %1</source>
        <translation>%1 arasında bir sayı</translation>
    </message>
    <message>
        <source>at most %1 numbers, each in %2</source>
        <translation>en çok %1 sayı, her biri %2 arasında</translation>
    </message>
    <message>
        <source>a whole number in %1 .. %2</source>
        <translation>%1 .. %2 arasında bir tam sayı</translation>
    </message>
    <message>
        <source>one of %1</source>
        <translation>şunlardan biri: %1</translation>
    </message>
    <message>
        <source>three numbers, each in %1</source>
        <translation>üç sayı, her biri %1 arasında</translation>
    </message>
    <message>
        <source>[least, most], least below most, in %1</source>
        <translation>[en az, en çok], en az en çoktan küçük, %1 arasında</translation>
    </message>
    <message>
        <source>a table, [%1]</source>
        <translation>bir tablo, [%1]</translation>
    </message>
    <message>
        <source>a node id in 1 .. 126</source>
        <translation>1 .. 126 arasında düğüm kimliği</translation>
    </message>
    <message>
        <source>perhaps %1</source>
        <translation>belki %1</translation>
    </message>
    <message>
        <source>a key that does not exist</source>
        <translation>olmayan bir anahtar</translation>
    </message>
    <message>
        <source>a control character</source>
        <translation>bir kontrol karakteri</translation>
    </message>
    <message>
        <source>printable text, tabs and line ends</source>
        <translation>yazılabilir metin, sekmeler ve satır sonları</translation>
    </message>
    <message>
        <source>no valid TOML: %1</source>
        <translation>geçersiz TOML: %1</translation>
    </message>
    <message>
        <source>a machine that cannot work</source>
        <translation>çalışamayacak bir makine</translation>
    </message>
    <message>
        <source>a power of two</source>
        <translation>ikinin bir kuvveti</translation>
    </message>
    <message>
        <source>at most run_current_ma, %1</source>
        <translation>en çok run_current_ma, %1</translation>
    </message>
    <message>
        <source>node %1 axis %2</source>
        <translation>düğüm %1, eksen %2</translation>
    </message>
    <message>
        <source>a node&apos;s axis that no other joint has</source>
        <translation>başka eklemin kullanmadığı bir düğüm ekseni</translation>
    </message>
    <message>
        <source>at least acceleration + speed / stop ramp = %1, or a longer stop.ramp_ms</source>
        <translation>en az ivme + hız / durma rampası = %1, ya da daha uzun stop.ramp_ms</translation>
    </message>
    <message>
        <source>no frequency</source>
        <translation>frekans yok</translation>
    </message>
    <message>
        <source>the frequency of the vibration that the shaper is for</source>
        <translation>biçimlendiricinin giderdiği titreşimin frekansı</translation>
    </message>
    <message>
        <source>pressure advance of %1 s; allowed are 0 to %2 s</source>
        <translation>basınç öncülemesi %1 s; izin verilen 0 ile %2 s arası</translation>
    </message>
    <message>
        <source>pressure advance averaged over %1 s; allowed are 0 to %2 s</source>
        <translation>basınç öncülemesinin ortalaması %1 s üzerinden; izin verilen 0 ile %2 s arası</translation>
    </message>
    <message>
        <source>no such key with a linear model</source>
        <translation>doğrusal modelde böyle bir anahtar yok</translation>
    </message>
    <message>
        <source>the filament that this model presses together at most</source>
        <translation>bu modelin en çok sıkıştırdığı filament</translation>
    </message>
    <message>
        <source>a deviation without a shaper</source>
        <translation>biçimlendirici olmadan sapma</translation>
    </message>
    <message>
        <source>a shaper: without one nothing is moved off its path</source>
        <translation>bir biçimlendirici: o olmadan hiçbir şey yolundan ayrılmaz</translation>
    </message>
    <message>
        <source>different shapers on a machine that turns or tilts the part</source>
        <translation>parçayı döndüren ya da eğen bir makinede farklı biçimlendiriciler</translation>
    </message>
    <message>
        <source>one shaper for X, Y and Z, in [vibration] itself</source>
        <translation>X, Y ve Z için tek biçimlendirici, doğrudan [vibration] içinde</translation>
    </message>
    <message>
        <source>no table</source>
        <translation>tablo yok</translation>
    </message>
    <message>
        <source>[%1homing]: a joint with limited travel must find its position</source>
        <translation>[%1homing]: strok sınırı olan eklem konumunu bulmalı</translation>
    </message>
    <message>
        <source>a scale on a joint that turns</source>
        <translation>dönen bir eklemde cetvel</translation>
    </message>
    <message>
        <source>a machine that can stand nowhere in its workspace: at its bed reference, %1: %2</source>
        <translation>çalışma alanının hiçbir yerinde duramayan bir makine: tabla referansında, %1: %2</translation>
    </message>
    <message>
        <source>geometry, travel and workspace that fit each other</source>
        <translation>birbirine uyan geometri, strok ve çalışma alanı</translation>
    </message>
    <message>
        <source>a joint that moves along a rail</source>
        <translation>ray boyunca giden bir eklem</translation>
    </message>
    <message>
        <source>a scale on a joint that does not home at a switch</source>
        <translation>anahtarda referans almayan bir eklemde cetvel</translation>
    </message>
    <message>
        <source>[%1homing] with a method of 17..22: the switch&apos;s edge is where the scale begins</source>
        <translation>17..22 yöntemli [%1homing]: cetvel anahtarın kenarında başlar</translation>
    </message>
    <message>
        <source>no pitch</source>
        <translation>adım (pitch) yok</translation>
    </message>
    <message>
        <source>the pitch that the periodic error repeats with</source>
        <translation>periyodik hatanın yinelendiği adım</translation>
    </message>
    <message>
        <source>one number</source>
        <translation>tek sayı</translation>
    </message>
    <message>
        <source>two or more</source>
        <translation>iki ya da daha çok</translation>
    </message>
    <message>
        <source>the distance of the table&apos;s places, above 0</source>
        <translation>tablo yerleri arasındaki uzaklık, 0&apos;dan büyük</translation>
    </message>
    <message>
        <source>an error with a slope of %1</source>
        <translation>eğimi %1 olan hata</translation>
    </message>
    <message>
        <source>at most %1</source>
        <translation>en çok %1</translation>
    </message>
    <message>
        <source>a correction that needs nearly all of the joint&apos;s speed or acceleration</source>
        <translation>eklemin hız ya da ivmesinin neredeyse tümünü isteyen düzeltme</translation>
    </message>
    <message>
        <source>smaller errors, or higher limits of the joint</source>
        <translation>daha küçük hatalar ya da eklemde daha yüksek sınırlar</translation>
    </message>
    <message>
        <source>17..22, 37, -3 or -4</source>
        <translation>17..22, 37, -3 ya da -4</translation>
    </message>
    <message>
        <source>an input that is active when it is low</source>
        <translation>düşükken etkin olan bir giriş</translation>
    </message>
    <message>
        <source>active_low = false: DIAG of a driver is high when it tells a stop</source>
        <translation>active_low = false: sürücünün DIAG ucu bir dayanak bildirirken yüksektir</translation>
    </message>
    <message>
        <source>%1 on a node that drives the motor itself</source>
        <translation>motoru kendisi süren bir düğümde %1</translation>
    </message>
    <message>
        <source>a stepper driver that tells its load (TMC2209, TMC5160, TMC2130), and no [joint.%1.motor]; or a switch</source>
        <translation>yükünü bildiren bir adım motoru sürücüsü (TMC2209, TMC5160, TMC2130) ve [joint.%1.motor] olmadan; ya da bir anahtar</translation>
    </message>
    <message>
        <source>a load for a joint that does not home by it</source>
        <translation>yükle referans almayan bir eklem için yük</translation>
    </message>
    <message>
        <source>method = -3 or -4, or no stall_threshold</source>
        <translation>method = -3 ya da -4, ya da stall_threshold olmadan</translation>
    </message>
    <message>
        <source>method = -3 or -4, or no stall_above</source>
        <translation>method = -3 ya da -4, ya da stall_above olmadan</translation>
    </message>
    <message>
        <source>no stall_threshold</source>
        <translation>stall_threshold yok</translation>
    </message>
    <message>
        <source>1 to 255: the load at which the driver says stop, 255 the lightest</source>
        <translation>1 ile 255 arası: sürücünün dayanak dediği yük, 255 en hafifi</translation>
    </message>
    <message>
        <source>at least %1, which is %2 full steps a second: slower, a driver does not see the load</source>
        <translation>en az %1, yani saniyede %2 tam adım: daha yavaşta sürücü yükü görmez</translation>
    </message>
    <message>
        <source>as much as the fast speed, %1: both approaches by load are fast</source>
        <translation>hızlı hız kadar, %1: yükle yapılan iki yaklaşma da hızlıdır</translation>
    </message>
    <message>
        <source>%1 to %2: from %3 full steps a second to nine tenths of the fast speed</source>
        <translation>%1 ile %2 arası: saniyede %3 tam adımdan hızlı hızın onda dokuzuna</translation>
    </message>
    <message>
        <source>at least %1, 2.5 times the way to the fast speed: a load on the first half of it is no stop</source>
        <translation>en az %1, hızlı hıza çıkış yolunun 2,5 katı: bunun ilk yarısındaki yük dayanak değildir</translation>
    </message>
    <message>
        <source>%1, which first goes off the stop and brings tool and table together by that</source>
        <translation>önce dayanaktan uzaklaşan ve böylece takımla tablayı yaklaştıran %1</translation>
    </message>
    <message>
        <source>a switch (17..22) for a joint whose homing takes tool and table apart</source>
        <translation>referans alması takımla tablayı uzaklaştıran eklem için bir anahtar (17..22)</translation>
    </message>
    <message>
        <source>%1 is to home by its driver&apos;s load, and the driver does not answer node %2: look at the motor supply and the jumpers in its socket, or home it at a switch</source>
        <translation>%1 sürücüsünün yüküyle referans alacak, sürücü ise düğüm %2 için yanıt vermiyor: motor beslemesine ve yuvasındaki atlama tellerine bakın ya da anahtarla referans alın</translation>
    </message>
    <message>
        <source>%1 is to home by its driver&apos;s load, and node %2 has no driver there that tells it (TMC2209, TMC5160, TMC2130): home it at a switch, method 17 to 22</source>
        <translation>%1 sürücüsünün yüküyle referans alacak, düğüm %2 ise orada bunu bildiren bir sürücüye sahip değil (TMC2209, TMC5160, TMC2130): anahtarla referans alın, yöntem 17..22</translation>
    </message>
    <message>
        <source>%1: its driver told a stop where there is none, or not twice at one place; stall_threshold is too high, the motion too rough, or DIAG is not led to the input</source>
        <translation>%1: sürücüsü dayanak olmayan yerde dayanak bildirdi ya da iki kez aynı yerde bildirmedi; stall_threshold çok yüksek, hareket çok pürüzlü ya da DIAG girişe bağlı değil</translation>
    </message>
    <message>
        <source>%1 came to no stop by its driver&apos;s load; stall_threshold is too low, or max_search too short</source>
        <translation>%1 sürücüsünün yüküyle bir dayanak bulamadı; stall_threshold çok düşük ya da max_search çok kısa</translation>
    </message>
    <message>
        <source>at most the fast speed, %1</source>
        <translation>en çok hızlı hız, %1</translation>
    </message>
    <message>
        <source>at most the joint&apos;s speed, %1</source>
        <translation>en çok eklemin hızı, %1</translation>
    </message>
    <message>
        <source>at most the joint&apos;s acceleration, %1</source>
        <translation>en çok eklemin ivmesi, %1</translation>
    </message>
    <message>
        <source>within the joint&apos;s travel, %1 .. %2</source>
        <translation>eklemin stroku içinde, %1 .. %2</translation>
    </message>
    <message>
        <source>an input of node %1 that has the home function for axis %2</source>
        <translation>düğüm %1 üzerinde %2 ekseninin referans işlevli girişi</translation>
    </message>
    <message>
        <source>an input of node %1 that has the limit function for axis %2</source>
        <translation>düğüm %1 üzerinde %2 ekseninin sınır işlevli girişi</translation>
    </message>
    <message>
        <source>at most max_c of [heater.%1], %2</source>
        <translation>en çok [heater.%1] tablosundaki max_c, %2</translation>
    </message>
    <message>
        <source>0, or a heater of this kind</source>
        <translation>0, ya da bu türden bir ısıtıcı</translation>
    </message>
    <message>
        <source>an index that no other heater of the kind has: [heater.%1] has it</source>
        <translation>aynı türden başka ısıtıcının taşımadığı bir sıra numarası: [heater.%1] taşıyor</translation>
    </message>
    <message>
        <source>an index that no other has: [%1] has it</source>
        <translation>başkasının taşımadığı bir sıra numarası: [%1] taşıyor</translation>
    </message>
    <message>
        <source>a node that has such channels: %1 is 0</source>
        <translation>böyle kanalları olan bir düğüm: %1 0</translation>
    </message>
    <message>
        <source>a channel in 1 .. %1, as %2 says</source>
        <translation>%2 anahtarının dediği gibi 1 .. %1 arasında bir kanal</translation>
    </message>
    <message>
        <source>node %1 channel %2</source>
        <translation>düğüm %1, kanal %2</translation>
    </message>
    <message>
        <source>a channel that no other device has: [%1] has it</source>
        <translation>başka aygıtın kullanmadığı bir kanal: [%1] kullanıyor</translation>
    </message>
    <message>
        <source>a function</source>
        <translation>bir işlev</translation>
    </message>
    <message>
        <source>an input that the node has: %1 is %2</source>
        <translation>düğümde bulunan bir giriş: %1 %2</translation>
    </message>
    <message>
        <source>a switch of an axis</source>
        <translation>bir eksenin anahtarı</translation>
    </message>
    <message>
        <source>none, emergency_stop or probe: this node has no axes</source>
        <translation>none, emergency_stop ya da probe: bu düğümün ekseni yok</translation>
    </message>
    <message>
        <source>a node that has axes: node.%1.axis_pairs is 0</source>
        <translation>ekseni olan bir düğüm: node.%1.axis_pairs 0</translation>
    </message>
    <message>
        <source>an input of node %1 that has the probe function</source>
        <translation>düğüm %1 üzerinde prob işlevli bir giriş</translation>
    </message>
    <message>
        <source>no such key: a heater that is not there has no table</source>
        <translation>böyle bir anahtar yok: bulunmayan ısıtıcının tablosu olmaz</translation>
    </message>
    <message>
        <source>[heater.hotend] with kind = &quot;hotend&quot;, where = &quot;simulated&quot; and the same keys; a machine without hot end has no such table</source>
        <translation>kind = &quot;hotend&quot;, where = &quot;simulated&quot; ve aynı anahtarlarla [heater.hotend]; nozulu olmayan makinede böyle bir tablo olmaz</translation>
    </message>
    <message>
        <source>[heater.bed] with kind = &quot;bed&quot;, where = &quot;simulated&quot; and the same keys; a machine without heated bed has no such table</source>
        <translation>kind = &quot;bed&quot;, where = &quot;simulated&quot; ve aynı anahtarlarla [heater.bed]; tablası ısıtılmayan makinede böyle bir tablo olmaz</translation>
    </message>
    <message>
        <source>no such key: a machine without spindle has no table [spindle]</source>
        <translation>böyle bir anahtar yok: iş mili olmayan makinede [spindle] tablosu olmaz</translation>
    </message>
    <message>
        <source>no such key with the tool in the frame: the table&apos;s centre is the platform&apos;s zero</source>
        <translation>takım gövdedeyken böyle bir anahtar yok: tablanın merkezi platformun sıfırıdır</translation>
    </message>
    <message>
        <source>at most %1 tables with names of 1 .. %2 letters, digits, - and _</source>
        <translation>adları 1 .. %2 harf, rakam, - ve _ olan en çok %1 tablo</translation>
    </message>
    <message>
        <source>%1 is to live on node %2, where this gateway knows no such device: use where = &quot;simulated&quot;</source>
        <translation>%1 düğüm %2 üzerinde olacak, ama bu ağ geçidi orada böyle bir aygıt tanımıyor: where = &quot;simulated&quot; yazın</translation>
    </message>
    <message>
        <source>M42 needs the output P and its value S</source>
        <translation>M42 çıkış P ile değeri S ister</translation>
    </message>
    <message>
        <source>an output&apos;s value S is 0 to 255</source>
        <translation>bir çıkışın değeri S 0 ile 255 arasındadır</translation>
    </message>
    <message>
        <source>a job is under way: it chooses its tools</source>
        <translation>bir iş sürüyor: takımlarını kendi seçer</translation>
    </message>
    <message>
        <source>hotend T%1</source>
        <translation>nozul T%1</translation>
    </message>
    <message>
        <source>bed %1</source>
        <translation>tabla %1</translation>
    </message>
    <message>
        <source>chamber</source>
        <translation>kabin</translation>
    </message>
    <message>
        <source>chamber %1</source>
        <translation>kabin %1</translation>
    </message>
    <message>
        <source>a node that has axes: it tells when an input changes</source>
        <translation>eksenleri olan bir düğüm: bir giriş değişince bunu o bildirir</translation>
    </message>
    <message>
        <source>an input of node %1 whose function is none: a switch, a stop or a probe is not a job&apos;s to read</source>
        <translation>düğüm %1 üzerinde işlevi none olan bir giriş: anahtarı, durdurmayı ve probu iş okuyamaz</translation>
    </message>
    <message>
        <source>M66 E reads an analogue input, which machines of this kind do not have: P reads a digital one</source>
        <translation>M66 E bir analog giriş okur; bu tür makinelerde analog giriş yok: P sayısal girişi okur</translation>
    </message>
    <message>
        <source>M66 needs the input P</source>
        <translation>M66 için giriş P gerekli</translation>
    </message>
    <message>
        <source>M66 L1 to L4 waits at most Q seconds: more than 0, at most %1</source>
        <translation>M66 L1 ile L4 en çok Q saniye bekler: 0&apos;dan büyük, en çok %1</translation>
    </message>
    <message>
        <source>the job reads an input here: what follows is checked as if what it waits for came (M66 without L: as if the input were off), and again with what is read, just before it moves</source>
        <translation>iş burada bir giriş okuyor: sonrası, beklenen gelmiş gibi (L&apos;siz M66: giriş kapalıymış gibi) kontrol edilir, okunan değerle de hareketten hemen önce bir kez daha</translation>
    </message>
    <message>
        <source>a macro or loop with M66 works in a job, not as a line: the lines behind M66 have to know what it reads</source>
        <translation>M66 içeren makro ya da döngü bir işte çalışır, tek satır olarak değil: M66&apos;dan sonraki satırlar okunanı bilmeli</translation>
    </message>
    <message>
        <source>this machine has no input %1: the machine file names inputs by [input.NAME]</source>
        <translation>bu makinede giriş %1 yok: makine dosyası girişleri [input.NAME] ile adlandırır</translation>
    </message>
    <message>
        <source>waiting for input %1</source>
        <translation>giriş %1 bekleniyor</translation>
    </message>
    <message>
        <source>input %1 has not come in time: #5399 is -1</source>
        <translation>giriş %1 zamanında gelmedi: #5399 = -1</translation>
    </message>
    <message>
        <source>this machine has no output %1</source>
        <translation>bu makinede çıkış %1 yok</translation>
    </message>
    <message>
        <source>this machine has no fan %1: M106 has no effect</source>
        <translation>bu makinede fan %1 yok: M106 etkisizdir</translation>
    </message>
    <message>
        <source>waiting for the %1 at %2</source>
        <translation>%1 %2 olsun diye bekleniyor</translation>
    </message>
    <message>
        <source>this machine has no such heater</source>
        <translation>bu makinede böyle bir ısıtıcı yok</translation>
    </message>
    <message>
        <source>a node that has its table, [node.%1]</source>
        <translation>tablosu olan bir düğüm, [node.%1]</translation>
    </message>
    <message>
        <source>%1, which homes towards the nozzle</source>
        <translation>%1, nozula doğru referansa gidiyor</translation>
    </message>
    <message>
        <source>homing away from the nozzle: method %1, with the switch at the rail&apos;s other end</source>
        <translation>nozuldan uzağa referansa gitme: yöntem %1, anahtar rayın öbür ucunda</translation>
    </message>
    <message>
        <source>an even number: ramps travel in 2 ms</source>
        <translation>çift sayı: rampalar 2 ms&apos;lik adımlarla gider</translation>
    </message>
    <message>
        <source>at least stop.ramp_ms, %1</source>
        <translation>en az stop.ramp_ms, %1</translation>
    </message>
    <message>
        <source>at least two SYNC periods, %1</source>
        <translation>en az iki SYNC süresi, %1</translation>
    </message>
    <message>
        <source>at least two heartbeats, %1</source>
        <translation>en az iki kalp atışı, %1</translation>
    </message>
    <message>
        <source>a network interface&apos;s name of 1 .. 15 characters</source>
        <translation>1 .. 15 karakterlik bir ağ arayüzü adı</translation>
    </message>
    <message>
        <source>at most the tool&apos;s speed, %1</source>
        <translation>en çok takımın hızı, %1</translation>
    </message>
    <message>
        <source>at most the largest speed, %1</source>
        <translation>en çok en yüksek hız, %1</translation>
    </message>
    <message>
        <source>an empty name</source>
        <translation>boş ad</translation>
    </message>
    <message>
        <source>a name</source>
        <translation>bir ad</translation>
    </message>
    <message>
        <source>an empty path</source>
        <translation>boş yol</translation>
    </message>
    <message>
        <source>a directory</source>
        <translation>bir klasör</translation>
    </message>
    <message>
        <source>the machine file&apos;s geometry cannot work: %1</source>
        <translation>makine dosyasındaki geometri çalışamaz: %1</translation>
    </message>
    <message>
        <source>stop by command</source>
        <translation>komutla durduruldu</translation>
    </message>
    <message>
        <source>the drives do not change their mode of operation</source>
        <translation>sürücüler çalışma kipini değiştirmiyor</translation>
    </message>
    <message>
        <source>%1: its drive is no longer enabled</source>
        <translation>%1: sürücüsü artık açık değil</translation>
    </message>
    <message>
        <source>%1 did not find its home switch, or the switch did not release: is it wired to another carriage?</source>
        <translation>%1 referans anahtarını bulamadı ya da anahtar bırakmadı: kablosu başka bir taşıyıcıya mı gidiyor?</translation>
    </message>
    <message>
        <source>homing took too long; not at home: %1</source>
        <translation>referansa gitme çok uzun sürdü; referansta olmayanlar: %1</translation>
    </message>
    <message>
        <source>%1 has gone %2 mm farther than another carriage; allowed are %3 mm</source>
        <translation>%1 başka bir taşıyıcıdan %2 mm ileri gitti; izin verilen %3 mm</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>hareket ediyor</translation>
    </message>
    <message>
        <source>waiting for lines</source>
        <translation>satır bekliyor</translation>
    </message>
    <message>
        <source>reading the job up to where it was</source>
        <translation>iş kaldığı yere kadar okunuyor</translation>
    </message>
    <message>
        <source>interrupted</source>
        <translation>kesildi</translation>
    </message>
    <message>
        <source>dwelling</source>
        <translation>bekliyor</translation>
    </message>
    <message>
        <source>waiting for the spindle</source>
        <translation>iş mili bekleniyor</translation>
    </message>
    <message>
        <source>paused by the job</source>
        <translation>iş duraklattı</translation>
    </message>
    <message>
        <source>the job pauses here: resume to go on</source>
        <translation>iş burada duraklıyor: devam için sürdürün</translation>
    </message>
    <message>
        <source>M18/M84 in a job: the motors go on holding</source>
        <translation>işte M18/M84: motorlar tutmayı sürdürüyor</translation>
    </message>
    <message>
        <source>node %1, object %2: no answer</source>
        <translation>düğüm %1, nesne %2: yanıt yok</translation>
    </message>
    <message>
        <source>node %1, object %2: %3</source>
        <translation>düğüm %1, nesne %2: %3</translation>
    </message>
    <message>
        <source>bring up</source>
        <translation>devreye alma</translation>
    </message>
    <message>
        <source>home</source>
        <translation>referansa gitme</translation>
    </message>
    <message>
        <source>go to the bed reference</source>
        <translation>tabla referansına gitme</translation>
    </message>
    <message>
        <source>jog</source>
        <translation>manuel hareket</translation>
    </message>
    <message>
        <source>run a job</source>
        <translation>iş çalıştırma</translation>
    </message>
    <message>
        <source>hold</source>
        <translation>duraklatma</translation>
    </message>
    <message>
        <source>resume</source>
        <translation>sürdürme</translation>
    </message>
    <message>
        <source>cancel</source>
        <translation>iptal</translation>
    </message>
    <message>
        <source>stop</source>
        <translation>durdurma</translation>
    </message>
    <message>
        <source>set the feed override</source>
        <translation>hız ayarı</translation>
    </message>
    <message>
        <source>switch the motors off</source>
        <translation>motorları kapatma</translation>
    </message>
    <message>
        <source>set a temperature</source>
        <translation>sıcaklık ayarı</translation>
    </message>
    <message>
        <source>set the fan</source>
        <translation>fan ayarı</translation>
    </message>
    <message>
        <source>set an output</source>
        <translation>bir çıkışın ayarı</translation>
    </message>
    <message>
        <source>an output&apos;s ratio is 0 to 1</source>
        <translation>bir çıkışın oranı 0 ile 1 arasıdır</translation>
    </message>
    <message>
        <source>turn the spindle</source>
        <translation>iş milini döndürme</translation>
    </message>
    <message>
        <source>set a work offset</source>
        <translation>iş ofseti ayarı</translation>
    </message>
    <message>
        <source>off</source>
        <translation>kapalı</translation>
    </message>
    <message>
        <source>bring-up</source>
        <translation>devreye alınıyor</translation>
    </message>
    <message>
        <source>not homed</source>
        <translation>referansa gidilmedi</translation>
    </message>
    <message>
        <source>homing</source>
        <translation>referansa gidiyor</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>hazır</translation>
    </message>
    <message>
        <source>checking the job</source>
        <translation>iş kontrol ediliyor</translation>
    </message>
    <message>
        <source>running</source>
        <translation>çalışıyor</translation>
    </message>
    <message>
        <source>holding</source>
        <translation>duraklıyor</translation>
    </message>
    <message>
        <source>held</source>
        <translation>duraklatıldı</translation>
    </message>
    <message>
        <source>cancelling</source>
        <translation>iptal ediliyor</translation>
    </message>
    <message>
        <source>stopping</source>
        <translation>duruyor</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>durdu</translation>
    </message>
    <message>
        <source>alarm</source>
        <translation>alarm</translation>
    </message>
    <message>
        <source>a temperature needs S</source>
        <translation>sıcaklık S ister</translation>
    </message>
    <message>
        <source>the lines&apos; host has gone: what is left of them is given up</source>
        <translation>satırların sunucusu gitti: satırlardan kalan bırakıldı</translation>
    </message>
    <message>
        <source>the heaters are off: %1</source>
        <translation>ısıtıcılar kapatıldı: %1</translation>
    </message>
    <message>
        <source>nothing has moved for %1 minutes</source>
        <translation>%1 dakikadır hiçbir şey hareket etmedi</translation>
    </message>
    <message>
        <source>the tool is not lifted as far as it should be: %1</source>
        <translation>takım gerektiği kadar kaldırılmadı: %1</translation>
    </message>
    <message>
        <source>the job is held at X%1 Y%2 Z%3: mend what is wrong, then resume heats and goes on</source>
        <translation>iş X%1 Y%2 Z%3 noktasında duraklatıldı: bozuk olanı onarın, sonra sürdürün; iş önce ısıtır, sonra devam eder</translation>
    </message>
    <message>
        <source>there is no filament any more</source>
        <translation>artık filament yok</translation>
    </message>
    <message>
        <source>the extruder turns and the filament stands still</source>
        <translation>ekstrüder dönüyor ama filament ilerlemiyor</translation>
    </message>
    <message>
        <source>less filament comes than the extruder turns for</source>
        <translation>ekstrüderin döndüğünden daha az filament geliyor</translation>
    </message>
    <message>
        <source>at least %1, %2 edges</source>
        <translation>en az %1, %2 darbe kenarı</translation>
    </message>
    <message>
        <source>Filament does not come</source>
        <translation>Filament gelmiyor</translation>
    </message>
    <message>
        <source>put filament in, or free it on its way, then resume</source>
        <translation>filament takın ya da yolunda serbest bırakın, sonra sürdürün</translation>
    </message>
    <message>
        <source>the job was cancelled</source>
        <translation>iş iptal edildi</translation>
    </message>
    <message>
        <source>at least %1 below limit_c, which is at most %2</source>
        <translation>en çok %2 olan limit_c değerinin en az %1 altında</translation>
    </message>
    <message>
        <source>at most max_c</source>
        <translation>en çok max_c</translation>
    </message>
    <message>
        <source>0 of a node that carries heat</source>
        <translation>ısı taşıyan bir düğümde 0</translation>
    </message>
    <message>
        <source>at most %1 on a heat node</source>
        <translation>bir ısı düğümünde en çok %1</translation>
    </message>
    <message>
        <source>at most %1 on a heat node, with those of the heaters</source>
        <translation>bir ısı düğümünde, ısıtıcılarınkilerle birlikte en çok %1</translation>
    </message>
    <message>
        <source>its node says that it is out of order</source>
        <translation>düğümü, bozuk olduğunu bildiriyor</translation>
    </message>
    <message>
        <source>its node refuses %1 C: %2</source>
        <translation>düğümü %1 °C değerini reddediyor: %2</translation>
    </message>
    <message>
        <source>its node has switched it off, and not by this gateway</source>
        <translation>düğümü onu kapattı; kapatan bu ağ geçidi değil</translation>
    </message>
    <message>
        <source>its node tells no temperatures any more</source>
        <translation>düğümü artık sıcaklık bildirmiyor</translation>
    </message>
    <message>
        <source>node %1, which heats it, is not in operation: bring the machine up first</source>
        <translation>onu ısıtan düğüm %1 çalışmıyor: önce makineyi devreye alın</translation>
    </message>
    <message>
        <source>M112 of the session</source>
        <translation>oturumdan M112</translation>
    </message>
    <message>
        <source>stop by the session</source>
        <translation>oturum durdurdu</translation>
    </message>
    <message>
        <source>not a command of a session: %1; send motion as a job</source>
        <translation>oturum komutu değil: %1; hareketi iş olarak gönderin</translation>
    </message>
    <message>
        <source>line %1: the path leaves the machine&apos;s reach: %2</source>
        <translation>satır %1: yol makinenin erişiminden çıkıyor: %2</translation>
    </message>
    <message>
        <source>line %1: the move&apos;s frame differs from the path&apos;s; the frame may only change by a position given at rest</source>
        <translation>satır %1: hareketin çerçevesi yolunkinden farklı; çerçeve yalnız dururken verilen konumla değişebilir</translation>
    </message>
    <message>
        <source>line %1: a coordinate is not a number, or the feed is not greater than 0</source>
        <translation>satır %1: bir koordinat sayı değil ya da ilerleme 0&apos;dan büyük değil</translation>
    </message>
    <message>
        <source>line %1: centre, normal, sweep and target do not make an arc</source>
        <translation>satır %1: merkez, normal, açı ve hedef bir yay oluşturmuyor</translation>
    </message>
    <message>
        <source>line %1: unknown error</source>
        <translation>satır %1: bilinmeyen hata</translation>
    </message>
    <message>
        <source>%1 has control of the machine</source>
        <translation>makinenin kontrolü %1 programında</translation>
    </message>
    <message>
        <source>ask for it to be handed over, or take control by force</source>
        <translation>devredilmesini isteyin ya da kontrolü zorla alın</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>kontrol %1 programında</translation>
    </message>
    <message>
        <source>nobody has control</source>
        <translation>kontrol kimsede değil</translation>
    </message>
    <message>
        <source>the gateway and the client speak different versions of the job link</source>
        <translation>ağ geçidi ile istemci iş bağlantısının farklı sürümlerini konuşuyor</translation>
    </message>
    <message>
        <source>version %1</source>
        <translation>sürüm %1</translation>
    </message>
    <message>
        <source>the token is wrong</source>
        <translation>belirteç yanlış</translation>
    </message>
    <message>
        <source>the token that is set on the gateway</source>
        <translation>ağ geçidinde ayarlı belirteç</translation>
    </message>
    <message>
        <source>say hello first</source>
        <translation>önce selam (hello) gönderin</translation>
    </message>
    <message>
        <source>this gateway does not know the request</source>
        <translation>bu ağ geçidi bu isteği tanımıyor</translation>
    </message>
    <message>
        <source>the answer is longer than one message may be</source>
        <translation>yanıt, bir iletinin olabileceğinden daha uzun</translation>
    </message>
    <message>
        <source>all places for clients are taken: only stop and questions about the state are answered</source>
        <translation>istemci yerlerinin tümü dolu: yalnızca durdurma ve durum soruları yanıtlanır</translation>
    </message>
    <message>
        <source>the machine file is no text in UTF-8</source>
        <translation>makine dosyası UTF-8 metni değil</translation>
    </message>
    <message>
        <source>a job&apos;s name is text in UTF-8, without control characters and marks of direction</source>
        <translation>bir işin adı UTF-8 metnidir; kontrol karakteri ve yön işareti içermez</translation>
    </message>
    <message>
        <source>a client is sending this upload</source>
        <translation>bir istemci bu yüklemeyi gönderiyor</translation>
    </message>
    <message>
        <source>no upload of this name is half done</source>
        <translation>bu adla yarım kalmış yükleme yok</translation>
    </message>
    <message>
        <source>this job is running</source>
        <translation>bu iş çalışıyor</translation>
    </message>
    <message>
        <source>%1 was started before: a job of its name runs once</source>
        <translation>%1 daha önce başlatıldı: böyle adlı bir iş bir kez çalışır</translation>
    </message>
    <message>
        <source>nobody waits for it any more</source>
        <translation>artık onu bekleyen yok</translation>
    </message>
    <message>
        <source>too many jobs are being checked: ask again later</source>
        <translation>çok fazla iş kontrol ediliyor: sonra yeniden isteyin</translation>
    </message>
    <message>
        <source>a machine file has at most 512 KiB</source>
        <translation>makine dosyası en çok 512 KiB olur</translation>
    </message>
    <message>
        <source>the file was changed by somebody else: read it again</source>
        <translation>dosyayı başkası değiştirdi: yeniden okuyun</translation>
    </message>
    <message>
        <source>control is handed over by the client that has it, to a client that is here</source>
        <translation>kontrolü elinde tutan, burada olan birine devredebilir</translation>
    </message>
    <message>
        <source>a fan&apos;s ratio is 0 to 1</source>
        <translation>fan oranı 0 ile 1 arasındadır</translation>
    </message>
    <message>
        <source>a work coordinate system is 1 (G54) to 9 (G59.3)</source>
        <translation>iş koordinat sistemi 1 (G54) ile 9 (G59.3) arasındadır</translation>
    </message>
    <message>
        <source>a work offset needs numbers below 1000 m</source>
        <translation>iş ofseti 1000 m&apos;den küçük sayılar ister</translation>
    </message>
    <message>
        <source>the gateway ended while the job ran</source>
        <translation>iş çalışırken ağ geçidi kapandı</translation>
    </message>
    <message>
        <source>missing</source>
        <translation>eksik</translation>
    </message>
    <message>
        <source>found %1</source>
        <translation>bulunan: %1</translation>
    </message>
    <message>
        <source>line %1: %2</source>
        <translation>satır %1: %2</translation>
    </message>
    <message>
        <source>the path leaves the machine&apos;s reach</source>
        <translation>yol makinenin erişiminden çıkıyor</translation>
    </message>
    <message>
        <source>a phase came when none was asked for</source>
        <translation>istenmeden bir evre geldi</translation>
    </message>
    <message>
        <source>the run does not start where the axis stands (counts apart)</source>
        <translation>hareket eksenin durduğu yerden başlamıyor (sayım farkı)</translation>
    </message>
    <message>
        <source>the run must begin and end at rest (counts/s)</source>
        <translation>hareket dururken başlayıp bitmeli (sayım/s)</translation>
    </message>
    <message>
        <source>the node lost a record (waits for record)</source>
        <translation>düğüm bir kayıt yitirdi (beklediği kayıt)</translation>
    </message>
    <message>
        <source>the node&apos;s state differs from the gateway&apos;s</source>
        <translation>düğümün durumu ağ geçidininkinden farklı</translation>
    </message>
    <message>
        <source>the node has taken a record otherwise than it was sent</source>
        <translation>düğüm bir kaydı gönderildiğinden başka türlü aldı</translation>
    </message>
    <message>
        <source>the node ran out of records</source>
        <translation>düğümün kayıtları bitti</translation>
    </message>
    <message>
        <source>the node expects a record that was never sent (record)</source>
        <translation>düğüm hiç gönderilmemiş bir kayıt bekliyor (kayıt)</translation>
    </message>
    <message>
        <source>records were sent but not accepted (ms)</source>
        <translation>kayıtlar gönderildi ama alınmadı (ms)</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>bilinmiyor</translation>
    </message>
    <message>
        <source>%1, node %2</source>
        <translation>%1, düğüm %2</translation>
    </message>
    <message>
        <source>%1 axis %2</source>
        <translation>%1 ekseni %2</translation>
    </message>
    <message>
        <source>%1, line %2</source>
        <translation>%1, satır %2</translation>
    </message>
    <message>
        <source>give one of them another id (kinebus-node-id) or take it off the bus, then clear and bring up again</source>
        <translation>birine başka kimlik verin (kinebus-node-id) ya da onu veri yolundan çıkarın, sonra alarmı kaldırıp yeniden devreye alın</translation>
    </message>
    <message>
        <source>two nodes use the id %1: those with the serial numbers %2 and %3</source>
        <translation>iki düğüm %1 kimliğini kullanıyor: seri numaraları %2 ve %3</translation>
    </message>
    <message>
        <source>%1: go to the bed reference first</source>
        <translation>%1. Önce tabla referansına gidin</translation>
    </message>
    <message>
        <source>A node does not answer</source>
        <translation>Bir düğüm yanıt vermiyor</translation>
    </message>
    <message>
        <source>The wrong node is connected</source>
        <translation>Yanlış düğüm bağlı</translation>
    </message>
    <message>
        <source>A node refuses its settings</source>
        <translation>Bir düğüm ayarlarını kabul etmiyor</translation>
    </message>
    <message>
        <source>A drive does not switch on</source>
        <translation>Bir sürücü açılmıyor</translation>
    </message>
    <message>
        <source>There is a second gateway on the bus</source>
        <translation>Veri yolunda ikinci bir ağ geçidi var</translation>
    </message>
    <message>
        <source>A node has gone silent</source>
        <translation>Bir düğüm sustu</translation>
    </message>
    <message>
        <source>A node has restarted</source>
        <translation>Bir düğüm yeniden başladı</translation>
    </message>
    <message>
        <source>The clocks have drifted apart</source>
        <translation>Saatler birbirinden ayrıldı</translation>
    </message>
    <message>
        <source>Homing has failed</source>
        <translation>Referansa gitme başarısız oldu</translation>
    </message>
    <message>
        <source>The carriages are too far apart</source>
        <translation>Taşıyıcılar birbirinden çok uzak</translation>
    </message>
    <message>
        <source>Homing took too long</source>
        <translation>Referansa gitme çok uzun sürdü</translation>
    </message>
    <message>
        <source>Motion was interrupted</source>
        <translation>Hareket kesildi</translation>
    </message>
    <message>
        <source>The nodes disagree about the path</source>
        <translation>Düğümler yol üzerinde anlaşamıyor</translation>
    </message>
    <message>
        <source>The bus has failed</source>
        <translation>Veri yolu arızalandı</translation>
    </message>
    <message>
        <source>A heater is too hot</source>
        <translation>Bir ısıtıcı çok sıcak</translation>
    </message>
    <message>
        <source>a heater is above its limit</source>
        <translation>bir ısıtıcı sınırının üzerinde</translation>
    </message>
    <message>
        <source>let it cool; check heater and sensor, then clear</source>
        <translation>soğumasını bekleyin; ısıtıcıyı ve algılayıcıyı kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>A temperature sensor is open</source>
        <translation>Bir sıcaklık algılayıcısında kopukluk var</translation>
    </message>
    <message>
        <source>a temperature sensor or its wire is open</source>
        <translation>bir sıcaklık algılayıcısı veya kablosu kopuk</translation>
    </message>
    <message>
        <source>check the sensor, its plug and its wires, then clear</source>
        <translation>algılayıcıyı, fişini ve kablolarını kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>A temperature sensor is shorted</source>
        <translation>Bir sıcaklık algılayıcısında kısa devre var</translation>
    </message>
    <message>
        <source>a temperature sensor is shorted</source>
        <translation>bir sıcaklık algılayıcısında kısa devre var</translation>
    </message>
    <message>
        <source>A temperature sensor jumps</source>
        <translation>Bir sıcaklık algılayıcısı sıçrıyor</translation>
    </message>
    <message>
        <source>a temperature changed faster than it can</source>
        <translation>bir sıcaklık olabileceğinden daha hızlı değişti</translation>
    </message>
    <message>
        <source>A temperature sensor is silent</source>
        <translation>Bir sıcaklık algılayıcısı susuyor</translation>
    </message>
    <message>
        <source>a temperature is not measured any more</source>
        <translation>bir sıcaklık artık ölçülmüyor</translation>
    </message>
    <message>
        <source>A heater does not heat as it should</source>
        <translation>Bir ısıtıcı gerektiği gibi ısıtmıyor</translation>
    </message>
    <message>
        <source>a heater&apos;s power does not arrive at its sensor</source>
        <translation>bir ısıtıcının gücü algılayıcısına ulaşmıyor</translation>
    </message>
    <message>
        <source>check that heater and sensor sit tight and are the right ones, then clear</source>
        <translation>ısıtıcı ile algılayıcının sıkı oturduğunu ve doğru parçalar olduğunu kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>A heater heats without being told to</source>
        <translation>Bir ısıtıcı komut verilmeden ısıtıyor</translation>
    </message>
    <message>
        <source>a heater&apos;s switch does not open: the contactor was opened</source>
        <translation>bir ısıtıcının anahtarı açılmıyor: kontaktör açıldı</translation>
    </message>
    <message>
        <source>switch off, let it cool, replace the heater&apos;s switch</source>
        <translation>kapatın, soğumasını bekleyin, ısıtıcının anahtarını değiştirin</translation>
    </message>
    <message>
        <source>A fan stands still</source>
        <translation>Bir fan duruyor</translation>
    </message>
    <message>
        <source>a fan does not turn</source>
        <translation>bir fan dönmüyor</translation>
    </message>
    <message>
        <source>check the fan and its plug, then clear</source>
        <translation>fanı ve fişini kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>A heater is not as it should be</source>
        <translation>Bir ısıtıcı olması gerektiği gibi değil</translation>
    </message>
    <message>
        <source>The job went wrong</source>
        <translation>İş ters gitti</translation>
    </message>
    <message>
        <source>Stopped by the operator</source>
        <translation>Operatör tarafından durduruldu</translation>
    </message>
    <message>
        <source>The machine did not come to rest</source>
        <translation>Makine durmadı</translation>
    </message>
    <message>
        <source>Too much current in a motor</source>
        <translation>Bir motorda aşırı akım</translation>
    </message>
    <message>
        <source>The supply voltage is wrong</source>
        <translation>Besleme gerilimi hatalı</translation>
    </message>
    <message>
        <source>A drive is too hot</source>
        <translation>Bir sürücü çok sıcak</translation>
    </message>
    <message>
        <source>Communication trouble on the bus</source>
        <translation>Veri yolunda iletişim sorunu</translation>
    </message>
    <message>
        <source>A node reports a fault</source>
        <translation>Bir düğüm arıza bildiriyor</translation>
    </message>
    <message>
        <source>Two nodes use the same id</source>
        <translation>İki düğüm aynı kimliği kullanıyor</translation>
    </message>
    <message>
        <source>A motor phase is shorted</source>
        <translation>Bir motor fazı kısa devre</translation>
    </message>
    <message>
        <source>A motor phase is open</source>
        <translation>Bir motor fazı kopuk</translation>
    </message>
    <message>
        <source>a motor phase carries no current</source>
        <translation>bir motor fazından akım geçmiyor</translation>
    </message>
    <message>
        <source>check the motor&apos;s plug and cable for a break, then clear</source>
        <translation>motorun fişinde ve kablosunda kopukluk arayın, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>The supply voltage is too high</source>
        <translation>Besleme gerilimi çok yüksek</translation>
    </message>
    <message>
        <source>The supply voltage is too low</source>
        <translation>Besleme gerilimi çok düşük</translation>
    </message>
    <message>
        <source>A node is too hot</source>
        <translation>Bir düğüm çok sıcak</translation>
    </message>
    <message>
        <source>A node&apos;s stored settings are damaged</source>
        <translation>Bir düğümün kayıtlı ayarları bozuk</translation>
    </message>
    <message>
        <source>A node&apos;s software has failed</source>
        <translation>Bir düğümün yazılımı hata verdi</translation>
    </message>
    <message>
        <source>An encoder has failed</source>
        <translation>Bir kodlayıcı arızalandı</translation>
    </message>
    <message>
        <source>A node has lost frames of the bus</source>
        <translation>Bir düğüm veri yolu çerçevelerini kaçırdı</translation>
    </message>
    <message>
        <source>Many errors on the bus</source>
        <translation>Veri yolunda çok sayıda hata</translation>
    </message>
    <message>
        <source>A node does not hear the gateway</source>
        <translation>Bir düğüm ağ geçidini duymuyor</translation>
    </message>
    <message>
        <source>A node was off the bus</source>
        <translation>Bir düğüm veri yolundan kopmuştu</translation>
    </message>
    <message>
        <source>A frame on the bus has a wrong value</source>
        <translation>Veri yolundaki bir çerçevede yanlış bir değer var</translation>
    </message>
    <message>
        <source>a PDO had a value that is not allowed</source>
        <translation>bir PDO&apos;da izin verilmeyen bir değer vardı</translation>
    </message>
    <message>
        <source>A frame on the bus has the wrong length</source>
        <translation>Veri yolundaki bir çerçevenin uzunluğu yanlış</translation>
    </message>
    <message>
        <source>a PDO was too short</source>
        <translation>bir PDO çok kısaydı</translation>
    </message>
    <message>
        <source>a PDO was too long</source>
        <translation>bir PDO çok uzundu</translation>
    </message>
    <message>
        <source>a SYNC had the wrong length</source>
        <translation>bir SYNC iletisinin uzunluğu yanlıştı</translation>
    </message>
    <message>
        <source>look for another master on the bus, update the node&apos;s firmware</source>
        <translation>veri yolunda başka bir yönetici arayın, düğümün yazılımını güncelleyin</translation>
    </message>
    <message>
        <source>A frame to a node did not come in time</source>
        <translation>Bir düğüme giden çerçeve zamanında gelmedi</translation>
    </message>
    <message>
        <source>A motor does not follow</source>
        <translation>Bir motor geri kaldı</translation>
    </message>
    <message>
        <source>A position limit was reached</source>
        <translation>Bir konum sınırına gelindi</translation>
    </message>
    <message>
        <source>A node has lost the common time</source>
        <translation>Bir düğüm ortak zamanı kaybetti</translation>
    </message>
    <message>
        <source>A node&apos;s queue ran low</source>
        <translation>Bir düğümün kuyruğu azaldı</translation>
    </message>
    <message>
        <source>A motion record was lost</source>
        <translation>Bir hareket kaydı kayboldu</translation>
    </message>
    <message>
        <source>A node is not where the gateway has sent it</source>
        <translation>Bir düğüm ağ geçidinin gönderdiği yerde değil</translation>
    </message>
    <message>
        <source>A motion record broke a node&apos;s limits</source>
        <translation>Bir hareket kaydı bir düğümün sınırlarını aştı</translation>
    </message>
    <message>
        <source>Drives were switched off in motion</source>
        <translation>Sürücüler hareket hâlinde kapatıldı</translation>
    </message>
    <message>
        <source>Emergency stop</source>
        <translation>Acil durdurma</translation>
    </message>
    <message>
        <source>A limit switch was reached</source>
        <translation>Bir sınır anahtarına gelindi</translation>
    </message>
    <message>
        <source>homing did not find the switch&apos;s edge</source>
        <translation>referansa gitme anahtarın kenarını bulamadı</translation>
    </message>
    <message>
        <source>this line taken out: every node speaks 1 Mbit/s, which is set on the interface (ip link set can0 type can bitrate 1000000)</source>
        <translation>bu satırın çıkarılması: her düğüm 1 Mbit/s konuşur, bu da arayüzde ayarlanır (ip link set can0 type can bitrate 1000000)</translation>
    </message>
    <message>
        <source>A node&apos;s power stage does not work</source>
        <translation>Bir düğümün güç katı çalışmıyor</translation>
    </message>
    <message>
        <source>the power stage does not measure the motor&apos;s currents</source>
        <translation>güç katı motorun akımlarını ölçmüyor</translation>
    </message>
    <message>
        <source>A node&apos;s program is for another board</source>
        <translation>Bir düğümün programı başka bir kart için</translation>
    </message>
    <message>
        <source>its program is for another board or chip: it drives nothing</source>
        <translation>programı başka bir kart ya da yonga için: hiçbir şeyi sürmüyor</translation>
    </message>
    <message>
        <source>A board cannot measure its crystal</source>
        <translation>Bir kart kristalini ölçemiyor</translation>
    </message>
    <message>
        <source>the crystal was not measured: the board runs as with its own one</source>
        <translation>kristal ölçülemedi: kart kendi kristaliyle gibi çalışıyor</translation>
    </message>
    <message>
        <source>check that the board is the one that the image is for</source>
        <translation>kartın, imajın yapıldığı kart olduğunu kontrol edin</translation>
    </message>
    <message>
        <source>write the program for this board (kinebus-setup boards shows what it is)</source>
        <translation>bu kartın programını yazın (hangi kart olduğunu kinebus-setup boards gösterir)</translation>
    </message>
    <message>
        <source>A motor that a board does not have was switched on</source>
        <translation>Kartta bulunmayan bir motor açıldı</translation>
    </message>
    <message>
        <source>this board has no motor driver for that axis</source>
        <translation>bu kartta o eksenin motor sürücüsü yok</translation>
    </message>
    <message>
        <source>take the axis out of the machine file, or name the node that has it</source>
        <translation>ekseni makine dosyasından çıkarın ya da onun bulunduğu düğümü yazın</translation>
    </message>
    <message>
        <source>switch the node off and on; when it comes again, replace the board</source>
        <translation>düğümü kapatıp açın; yinelenirse kartı değiştirin</translation>
    </message>
    <message>
        <source>carriage %1</source>
        <translation>taşıyıcı %1</translation>
    </message>
    <message>
        <source>rail %1</source>
        <translation>ray %1</translation>
    </message>
    <message>
        <source>platform</source>
        <translation>platform</translation>
    </message>
    <message>
        <source>beam</source>
        <translation>kiriş</translation>
    </message>
    <message>
        <source>table</source>
        <translation>tabla</translation>
    </message>
    <message>
        <source>part on the table</source>
        <translation>tabladaki parça</translation>
    </message>
    <message>
        <source>tool</source>
        <translation>takım</translation>
    </message>
    <message>
        <source>nozzle</source>
        <translation>nozul</translation>
    </message>
    <message>
        <source>spindle</source>
        <translation>iş mili</translation>
    </message>
    <message>
        <source>nozzle holder</source>
        <translation>nozul tutucusu</translation>
    </message>
    <message>
        <source>floor</source>
        <translation>zemin</translation>
    </message>
    <message>
        <source>%1 and %2 would touch</source>
        <translation>%1 ile %2 birbirine değerdi</translation>
    </message>
    <message>
        <source>%1 and %2 would come as near as %3 mm; bodies keep %4 mm apart</source>
        <translation>%1 ile %2 arasında %3 mm kalırdı; cisimler %4 mm uzak durur</translation>
    </message>
    <message>
        <source>above tool_radius_mm, %1: the tool&apos;s end is round</source>
        <translation>tool_radius_mm üzerinde, %1: takımın ucu yuvarlaktır</translation>
    </message>
    <message>
        <source>part_radius_mm and part_height_mm both above 0, or neither of them</source>
        <translation>part_radius_mm ve part_height_mm ikisi de 0 üzerinde, ya da hiçbiri</translation>
    </message>
    <message>
        <source>%1 tables</source>
        <translation>%1 tablo</translation>
    </message>
    <message>
        <source>a box turned inside out</source>
        <translation>içi dışına dönmüş bir kutu</translation>
    </message>
    <message>
        <source>each of its three numbers above that of from_mm</source>
        <translation>üç sayısının her biri from_mm değerinin üzerinde</translation>
    </message>
    <message>
        <source>a rod without length</source>
        <translation>uzunluğu olmayan bir çubuk</translation>
    </message>
    <message>
        <source>another point than from_mm</source>
        <translation>from_mm dışında bir nokta</translation>
    </message>
    <message>
        <source>bodies that touch: at %1, %2</source>
        <translation>değen cisimler: %1 konumunda %2</translation>
    </message>
    <message>
        <source>a machine that has room somewhere: this is its best pose</source>
        <translation>bir yerde boşluğu olan bir makine: bu en iyi konumudur</translation>
    </message>
    <message>
        <source>room at the bed reference, where the machine waits before a job</source>
        <translation>makinenin işten önce beklediği tabla referansında boşluk</translation>
    </message>
    <message>
        <source>an order of some joints</source>
        <translation>bazı eklemler için bir sıra</translation>
    </message>
    <message>
        <source>an order for every joint that homes, or for none: then it follows from the kinematics</source>
        <translation>referansa giden her eklem için bir sıra, ya da hiçbiri için: o zaman sıra kinematikten çıkar</translation>
    </message>
    <message>
        <source>homing that is not safe: begun at %1, at %2 %3</source>
        <translation>güvenli olmayan referansa gitme: %1 konumunda başlayınca %2 konumunda %3</translation>
    </message>
    <message>
        <source>homing that is not safe: begun at %1, from %2 on the mechanism cannot follow</source>
        <translation>güvenli olmayan referansa gitme: %1 konumunda başlayınca mekanizma %2 konumundan öteye izleyemiyor</translation>
    </message>
    <message>
        <source>switches that can be reached from everywhere: see kinebus plan --home</source>
        <translation>her yerden ulaşılabilen anahtarlar: kinebus plan --home gösterir</translation>
    </message>
    <message>
        <source>a lower part than %1 mm: see kinebus plan --home</source>
        <translation>%1 mm&apos;den alçak bir parça: kinebus plan --home gösterir</translation>
    </message>
    <message>
        <source>a joint that is led by its scale and has an error that is not linear</source>
        <translation>cetveline göre düzeltilen ve hatası doğrusal olmayan bir eklem</translation>
    </message>
    <message>
        <source>correction_mm = 0, or scale and offset alone in the calibration</source>
        <translation>correction_mm = 0 ya da kalibrasyonda yalnız scale ve offset</translation>
    </message>
    <message>
        <source>the part becomes higher than the %1 mm that homing spares: it must be off the table before the machine homes with its positions unknown</source>
        <translation>parça, referansa gitmenin dokunmadığı %1 mm&apos;den yüksek oluyor: makine konumları bilinmeden referansa gitmeden önce parça tabladan alınmalıdır</translation>
    </message>
    <message>
        <source>the part of the interrupted job is %1 mm high and homing spares %2 mm: cancel the job and take the part off the table, then home</source>
        <translation>kesilmiş işin parçası %1 mm yüksek, referansa gitme ise %2 mm&apos;ye kadar dokunmaz: işi iptal edin, parçayı tabladan alın, sonra referansa gönderin</translation>
    </message>
    <message>
        <source>the job was not begun: on the way to the bed reference %1</source>
        <translation>iş başlatılmadı: tabla referansına giderken %1</translation>
    </message>
    <message>
        <source>move the tool clear by hand, then run it again</source>
        <translation>takımı elle uzaklaştırın, sonra yeniden çalıştırın</translation>
    </message>
    <message>
        <source>an O word stands at the beginning of its line</source>
        <translation>bir O sözcüğü satırının başında durur</translation>
    </message>
    <message>
        <source>%1 turns with the spindle, which needs an encoder on it</source>
        <translation>%1 iş mili ile birlikte döner; bunun için mil üzerinde kodlayıcı gerekir</translation>
    </message>
    <message>
        <source>G76 means threading to some and fine boring to others; both need a spindle that follows an angle, which this machine does not have</source>
        <translation>G76 kimine göre diş açma, kimine göre hassas delik işlemedir; ikisi de açı izleyen bir iş mili ister, bu makinede yoktur</translation>
    </message>
    <message>
        <source>G87 needs a spindle that stops at an angle, which this machine does not have</source>
        <translation>G87 belirli bir açıda duran iş mili ister, bu makinede yoktur</translation>
    </message>
    <message>
        <source>G88 needs an operator who moves the axes by hand: use G82 or G86</source>
        <translation>G88 eksenleri elle hareket ettiren bir operatör ister: G82 ya da G86 kullanın</translation>
    </message>
    <message>
        <source>A is taken for extrusion (E), as the slicer in the file&apos;s header writes it</source>
        <translation>A, dosya başlığındaki dilimleyicinin yazdığı gibi ekstrüzyon (E) sayılıyor</translation>
    </message>
    <message>
        <source>%1 is not supported: write G10 L2 P0 with the values</source>
        <translation>%1 desteklenmiyor: değerlerle G10 L2 P0 yazın</translation>
    </message>
    <message>
        <source>load the filament, then go on</source>
        <translation>filamenti yükleyin, sonra devam edin</translation>
    </message>
    <message>
        <source>%1 is unknown; a macro of the printer is written as [macro.%1] in the machine file</source>
        <translation>%1 bilinmiyor; yazıcının makrosu makine dosyasına [macro.%1] olarak yazılır</translation>
    </message>
    <message>
        <source>A is taken for extrusion (E), as slicers write it for %1</source>
        <translation>A, dilimleyicilerin %1 için yazdığı gibi ekstrüzyon (E) sayılıyor</translation>
    </message>
    <message>
        <source>G10 needs L2 or L20 in this dialect (%1)</source>
        <translation>bu lehçede (%1) G10 L2 ya da L20 ister</translation>
    </message>
    <message>
        <source>the header names %1, which measures extrusion in mm^3: have the slicer write Marlin</source>
        <translation>başlık, ekstrüzyonu mm^3 ile ölçen %1 diyor: dilimleyici Marlin için yazsın</translation>
    </message>
    <message>
        <source>the header names %1, and the text is read as that dialect</source>
        <translation>başlık %1 diyor; metin o lehçeyle okunuyor</translation>
    </message>
    <message>
        <source>P of %1 is read as its value, as slicers write it for Mach3 and Machinekit</source>
        <translation>%1 içindeki P, dilimleyicilerin Mach3 ve Machinekit için yazdığı gibi değer sayılıyor</translation>
    </message>
    <message>
        <source>%1 needs the output E and its value Q</source>
        <translation>%1 E çıkışını ve Q değerini ister</translation>
    </message>
    <message>
        <source>an output&apos;s value Q is 0 to 1</source>
        <translation>bir çıkışın Q değeri 0 ile 1 arasındadır</translation>
    </message>
    <message>
        <source>the object %1 is left out</source>
        <translation>%1 nesnesi atlanıyor</translation>
    </message>
    <message>
        <source>no object of the print is at work here</source>
        <translation>burada baskının hiçbir nesnesi işlenmiyor</translation>
    </message>
    <message>
        <source>too many objects, or too long a name (1000 of 200 letters at most)</source>
        <translation>çok fazla nesne ya da çok uzun ad (en çok 1000 nesne, 200 harf)</translation>
    </message>
    <message>
        <source>%1 stands alone in its line</source>
        <translation>%1 satırında tek başına durur</translation>
    </message>
    <message>
        <source>M486 A needs a name in quotation marks</source>
        <translation>M486 A tırnak içinde bir ad ister</translation>
    </message>
    <message>
        <source>M486 takes S, P, U, T with a whole number, C and A&quot;name&quot;</source>
        <translation>M486 tam sayıyla S, P, U, T ile C ve A&quot;ad&quot; alır</translation>
    </message>
    <message>
        <source>G43.4 and tilted planes cannot begin or end while an object is left out</source>
        <translation>bir nesne atlanırken G43.4 ve eğik düzlem başlayamaz ve bitemez</translation>
    </message>
    <message>
        <source>change the filament, then go on</source>
        <translation>filamenti değiştirin, sonra devam edin</translation>
    </message>
    <message>
        <source>%1 needs %2, the bottom of the hole</source>
        <translation>%1 deliğin dibi olan %2 ister</translation>
    </message>
    <message>
        <source>%1 needs R, where the feed begins</source>
        <translation>%1 ilerlemenin başladığı R ister</translation>
    </message>
    <message>
        <source>%1 needs Q, the depth of a peck</source>
        <translation>%1 bir gagalama derinliği olan Q ister</translation>
    </message>
    <message>
        <source>the depth of a peck Q must be greater than 0</source>
        <translation>gagalama derinliği Q 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>%1 has no place in a canned cycle</source>
        <translation>%1 hazır çevrimde yer alamaz</translation>
    </message>
    <message>
        <source>a canned cycle needs feed per minute (G94)</source>
        <translation>hazır çevrim dakika başına ilerleme (G94) ister</translation>
    </message>
    <message>
        <source>%1 needs the spindle to turn (%2)</source>
        <translation>%1 için iş mili dönmeli (%2)</translation>
    </message>
    <message>
        <source>the tip of a lathe&apos;s tool (orientation %1) counts in the plane of G18 alone</source>
        <translation>torna takımının ucu (yönelim %1) yalnız G18 düzleminde geçerlidir</translation>
    </message>
    <message>
        <source>%1 needs a spindle of even speed: G97 first</source>
        <translation>%1 için iş mili sabit hızda dönmeli: önce G97</translation>
    </message>
    <message>
        <source>%1 needs K, the way of a turn</source>
        <translation>%1 için K, bir dönüşün yolu, gerekir</translation>
    </message>
    <message>
        <source>the way of a turn K must be greater than 0</source>
        <translation>bir dönüşün yolu K 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>%1 has no place in a thread</source>
        <translation>%1 bir dişte yer alamaz</translation>
    </message>
    <message>
        <source>%1 needs X, Y or Z, where the thread ends</source>
        <translation>%1 için dişin bittiği X, Y ya da Z gerekir</translation>
    </message>
    <message>
        <source>G76 needs %1 as P Z I J K: pitch, end, crest, first cut, height of the thread</source>
        <translation>G76 için %1 gerekir (P Z I J K): hatve, son, diş tepesi, ilk paso, diş yüksekliği</translation>
    </message>
    <message>
        <source>%1 must be greater than 0</source>
        <translation>%1 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>I of G76 says on which side the thread is: below 0 outside, above 0 inside</source>
        <translation>G76&apos;nın I değeri dişin hangi yanda olduğunu söyler: 0&apos;ın altı dış, 0&apos;ın üstü iç</translation>
    </message>
    <message>
        <source>R of G76 is at least 1</source>
        <translation>G76&apos;nın R değeri en az 1 olur</translation>
    </message>
    <message>
        <source>Q of G76 is 0 to %1 degrees</source>
        <translation>G76&apos;nın Q değeri 0 ile %1 derece arasındadır</translation>
    </message>
    <message>
        <source>L of G76 needs E, how long a taper is</source>
        <translation>G76&apos;nın L değeri için konik kısmın boyu E gerekir</translation>
    </message>
    <message>
        <source>the first cut J is far too small for this thread</source>
        <translation>ilk paso J bu diş için çok küçük</translation>
    </message>
    <message>
        <source>the thread of G76 has no length from here to Z</source>
        <translation>G76&apos;nın dişi buradan Z&apos;ye uzunluk bırakmıyor</translation>
    </message>
    <message>
        <source>%1 turns back in the hole with the spindle, which needs an encoder on it and spindle.tap_rpm_per_s in the machine file; G84 and G74 are for a floating holder</source>
        <translation>%1 delikte iş mili ile geri döner; bunun için iş milinde enkoder ve makine dosyasında spindle.tap_rpm_per_s gerekir; G84 ve G74 esnek tutucu içindir</translation>
    </message>
    <message>
        <source>a thread belongs to a job: it cannot wait for lines</source>
        <translation>diş bir işe aittir: satırları bekleyemez</translation>
    </message>
    <message>
        <source>the thread needs %1 at %2 rpm, a tenth more than S, and the plan reaches %3: a slower spindle, or more way before and behind the thread</source>
        <translation>diş için S&apos;den onda bir fazla olan %2 dev/dk&apos;da %1 gerekir, plan ise %3 hıza ulaşıyor: iş mili daha yavaş dönsün ya da dişin önünde ve arkasında daha çok yol olsun</translation>
    </message>
    <message>
        <source>the thread needs %1 at %2 rpm, a tenth more than S, and a limit slows the plan on the way: a slower spindle</source>
        <translation>diş için S&apos;den onda bir fazla olan %2 dev/dk&apos;da %1 gerekir, bir sınır ise planı yolda yavaşlatıyor: iş mili daha yavaş dönsün</translation>
    </message>
    <message>
        <source>the tool is in a thread: resume or cancel first</source>
        <translation>takım bir dişin içinde: önce sürdürün ya da iptal edin</translation>
    </message>
    <message>
        <source>taps need a spindle that is reversible and has encoder_counts</source>
        <translation>kılavuz çekmek için reversible olan ve encoder_counts taşıyan bir iş mili gerekir</translation>
    </message>
    <message>
        <source>the tool is in a tap: hold rests when it is out of the hole</source>
        <translation>takım kılavuz çekiyor: bekletme, delikten çıkınca durur</translation>
    </message>
    <message>
        <source>the axes cannot turn back as fast as the spindle in a tap: a slower spindle, or a smaller spindle.tap_rpm_per_s</source>
        <translation>eksenler kılavuzda iş mili kadar hızlı geri dönemez: daha yavaş bir iş mili ya da daha küçük spindle.tap_rpm_per_s</translation>
    </message>
    <message>
        <source>the tap needs %1 to be as fast as the spindle and to turn back with it, and has %2: a slower spindle, a greater spindle.tap_rpm_per_s, or more way before the hole</source>
        <translation>kılavuzun iş mili kadar hızlanıp onunla geri dönmesi için %1 gerekir, %2 var: daha yavaş bir iş mili, daha büyük spindle.tap_rpm_per_s ya da delikten önce daha çok yol</translation>
    </message>
    <message>
        <source>I of G33.1 is 1 at most: the way out is as fast as the way in</source>
        <translation>G33.1&apos;in I değeri en çok 1&apos;dir: çıkış giriş kadar hızlıdır</translation>
    </message>
    <message>
        <source>the job ends: it was stopped in a thread, which has to be cut in one go</source>
        <translation>iş bitiyor: tek seferde açılması gereken bir dişin içinde durduruldu</translation>
    </message>
    <message>
        <source>the thread is lost: the tool is %1 turns from the spindle&apos;s angle; a spindle may be a tenth faster than S</source>
        <translation>diş bozuldu: takım iş milinin açısından %1 dönüş uzakta; iş mili S&apos;den en çok onda bir hızlı olabilir</translation>
    </message>
    <message>
        <source>the bottom of the hole lies above R: %1 goes from R down</source>
        <translation>deliğin dibi R&apos;nin üstünde: %1 R&apos;den aşağı gider</translation>
    </message>
    <message>
        <source>the depth of a peck Q is far too small for this hole</source>
        <translation>gagalama derinliği Q bu delik için çok küçük</translation>
    </message>
    <message>
        <source>%1 cannot be below 0</source>
        <translation>%1 0&apos;ın altında olamaz</translation>
    </message>
    <message>
        <source>the depth of a cut I must be greater than 0</source>
        <translation>paso derinliği I 0&apos;dan büyük olmalı</translation>
    </message>
    <message>
        <source>%1 cannot stand in the profile of a cycle</source>
        <translation>%1 bir çevrimin profilinde bulunamaz</translation>
    </message>
    <message>
        <source>%1 works in the plane of G18, which is not tilted or turned</source>
        <translation>%1 eğilmemiş ve döndürülmemiş G18 düzleminde çalışır</translation>
    </message>
    <message>
        <source>%1 cannot stand in an object that is left out</source>
        <translation>%1 atlanan bir nesnede bulunamaz</translation>
    </message>
    <message>
        <source>%1 needs Q, the number of the subroutine that has the profile</source>
        <translation>%1 için Q gerekir: profili içeren alt programın numarası</translation>
    </message>
    <message>
        <source>the profile of a cycle lies in the plane of X and Z</source>
        <translation>bir çevrimin profili X ve Z düzlemindedir</translation>
    </message>
    <message>
        <source>A, C and E do not move in the profile of a cycle</source>
        <translation>A, C ve E bir çevrimin profilinde hareket etmez</translation>
    </message>
    <message>
        <source>the profile of a cycle has %1 moves at most</source>
        <translation>bir çevrimin profilinde en çok %1 hareket olur</translation>
    </message>
    <message>
        <source>only G0 to G3 can stand in the profile of a cycle</source>
        <translation>bir çevrimin profilinde yalnızca G0 ile G3 arası bulunabilir</translation>
    </message>
    <message>
        <source>the allowance D does not fit into this profile: an inside corner or arc is too narrow for it</source>
        <translation>pay D bu profile sığmıyor: bir iç köşe ya da yay onun için çok dar</translation>
    </message>
    <message>
        <source>the profile has no move behind the one that goes to it</source>
        <translation>profilde, ona giden hareketten sonra hareket yok</translation>
    </message>
    <message>
        <source>the profile turns back along X: G72 cannot cut it</source>
        <translation>profil X boyunca geri dönüyor: G72 onu kesemez</translation>
    </message>
    <message>
        <source>the profile turns back along Z: G71 cannot cut it</source>
        <translation>profil Z boyunca geri dönüyor: G71 onu kesemez</translation>
    </message>
    <message>
        <source>the depth of a cut I is far too small for this profile</source>
        <translation>paso derinliği I bu profil için çok küçük</translation>
    </message>
    <message>
        <source>G70 has too many passes P for this profile</source>
        <translation>G70&apos;te bu profil için çok fazla paso P var</translation>
    </message>
    <message>
        <source>a parameter&apos;s number must be a whole number from 1 to 5602</source>
        <translation>bir parametrenin numarası 1 ile 5602 arasında tam sayı olmalı</translation>
    </message>
    <message>
        <source>there is no parameter #%1; they are #1 to #5602</source>
        <translation>#%1 parametresi yok; parametreler #1 ile #5602 arasıdır</translation>
    </message>
    <message>
        <source>M61 needs the tool Q</source>
        <translation>M61 takım Q ister</translation>
    </message>
    <message>
        <source>%1 needs the output P</source>
        <translation>%1 çıkış P ister</translation>
    </message>
    <message>
        <source>volumetric extrusion (M200 D) is not supported: use lengths of filament</source>
        <translation>hacimsel ekstrüzyon (M200 D) desteklenmiyor: filament uzunluğu kullanın</translation>
    </message>
    <message>
        <source>M99 P is not supported: M99 goes back to the call</source>
        <translation>M99 P desteklenmiyor: M99 çağrıya geri döner</translation>
    </message>
    <message>
        <source>there is no macro %1</source>
        <translation>%1 makrosu yok</translation>
    </message>
    <message>
        <source>M98 needs the program P</source>
        <translation>M98 program P ister</translation>
    </message>
    <message>
        <source>put in the tool T%1, then go on</source>
        <translation>T%1 takımını takın, sonra devam edin</translation>
    </message>
    <message>
        <source>an O number has 9 digits at most</source>
        <translation>bir O numarası en çok 9 basamaklıdır</translation>
    </message>
    <message>
        <source>the name of an O word needs a closing &gt;</source>
        <translation>O sözcüğünün adı kapanan &gt; ister</translation>
    </message>
    <message>
        <source>the name of an O word is empty</source>
        <translation>O sözcüğünün adı boş</translation>
    </message>
    <message>
        <source>the name of an O word is too long (64 letters at most)</source>
        <translation>O sözcüğünün adı çok uzun (en çok 64 harf)</translation>
    </message>
    <message>
        <source>only a call may compute its O number</source>
        <translation>O numarasını yalnız bir çağrı hesaplayabilir</translation>
    </message>
    <message>
        <source>expected sub, call, if, while, do, repeat or another word of O after the label</source>
        <translation>etiketten sonra sub, call, if, while, do, repeat ya da başka bir O sözcüğü beklenir</translation>
    </message>
    <message>
        <source>G43.1 needs the tool&apos;s length Z, and a line without motion</source>
        <translation>G43.1 takım boyu Z ve hareketsiz bir satır ister</translation>
    </message>
    <message>
        <source>%1 uses the line&apos;s axis words: write the motion in another line</source>
        <translation>%1 satırın eksen sözcüklerini kullanır: hareketi başka satıra yazın</translation>
    </message>
    <message>
        <source>G68 needs R, the angle in degrees</source>
        <translation>G68 derece olarak açı R ister</translation>
    </message>
    <message>
        <source>G52 needs at least one axis word</source>
        <translation>G52 en az bir eksen sözcüğü ister</translation>
    </message>
    <message>
        <source>in the macro %1, line %2: %3</source>
        <translation>%1 makrosunda, satır %2: %3</translation>
    </message>
    <message>
        <source>%1 (called in line %2)</source>
        <translation>%1 (satır %2&apos;de çağrıldı)</translation>
    </message>
    <message>
        <source>%1 begins a program before the one above it has ended with M30</source>
        <translation>%1, üstündeki program M30 ile bitmeden yeni program başlatıyor</translation>
    </message>
    <message>
        <source>O words belong to a job: a single line can only call a macro</source>
        <translation>O sözcükleri işe aittir: tek satır yalnız makro çağırabilir</translation>
    </message>
    <message>
        <source>what has to be kept since line %1 is too long (16 MB or a million lines)</source>
        <translation>satır %1&apos;den beri saklanması gereken metin çok uzun (16 MB ya da bir milyon satır)</translation>
    </message>
    <message>
        <source>%1 has no beginning</source>
        <translation>%1 başlangıcı yok</translation>
    </message>
    <message>
        <source>%1 stands where %2 of line %3 is open</source>
        <translation>%1, satır %3&apos;teki %2 açıkken duruyor</translation>
    </message>
    <message>
        <source>%1 is defined already, in line %2</source>
        <translation>%1 zaten satır %2&apos;de tanımlı</translation>
    </message>
    <message>
        <source>O words are nested too deep (%1 levels at most)</source>
        <translation>O sözcükleri çok derin iç içe (en çok %1 düzey)</translation>
    </message>
    <message>
        <source>%1 is in no loop of this label</source>
        <translation>%1 bu etiketli bir döngüde değil</translation>
    </message>
    <message>
        <source>%1 has no end</source>
        <translation>%1 sonu yok</translation>
    </message>
    <message>
        <source>the program %1 has no M99 at its end</source>
        <translation>%1 programının sonunda M99 yok</translation>
    </message>
    <message>
        <source>loops and calls carry out more than %1 lines: one of them does not end</source>
        <translation>döngüler ve çağrılar %1 satırdan fazlasını yürütüyor: biri bitmiyor</translation>
    </message>
    <message>
        <source>%1 stands in no subroutine</source>
        <translation>%1 bir alt programda durmuyor</translation>
    </message>
    <message>
        <source>calls are nested too deep (%1 levels at most)</source>
        <translation>çağrılar çok derin iç içe (en çok %1 düzey)</translation>
    </message>
    <message>
        <source>the arguments of a call stand in [ ]</source>
        <translation>bir çağrının bağımsız değişkenleri [ ] içinde durur</translation>
    </message>
    <message>
        <source>a call has 30 arguments at most</source>
        <translation>bir çağrının en çok 30 bağımsız değişkeni olur</translation>
    </message>
    <message>
        <source>%1 is not defined above this call</source>
        <translation>%1 bu çağrının üstünde tanımlı değil</translation>
    </message>
    <message>
        <source>M99 ends a subprogram: a main program that begins again for ever is not run</source>
        <translation>M99 alt programı bitirir: sonsuza dek yeniden başlayan ana program yürütülmez</translation>
    </message>
    <message>
        <source>M98 P belongs to a job: a single line can only call a macro</source>
        <translation>M98 P işe aittir: tek satır yalnız makro çağırabilir</translation>
    </message>
    <message>
        <source>there is no program O%1 in this text</source>
        <translation>bu metinde O%1 programı yok</translation>
    </message>
    <message>
        <source>%1 needs the plane XY (G17)</source>
        <translation>%1 XY düzlemi (G17) ister</translation>
    </message>
    <message>
        <source>%1 needs feed per minute (G94)</source>
        <translation>%1 dakika başına ilerleme (G94) ister</translation>
    </message>
    <message>
        <source>%1 has no place in a spline</source>
        <translation>%1 spline içinde yer alamaz</translation>
    </message>
    <message>
        <source>%1 needs I and J</source>
        <translation>%1 I ve J ister</translation>
    </message>
    <message>
        <source>%1 needs P and Q</source>
        <translation>%1 P ve Q ister</translation>
    </message>
    <message>
        <source>%1 ends a NURBS, and none has begun</source>
        <translation>%1 bir NURBS&apos;ü bitirir, ama başlamış olan yok</translation>
    </message>
    <message>
        <source>%1 needs its order P</source>
        <translation>%1 için derecesi P gerekir</translation>
    </message>
    <message>
        <source>%1 stands in a line of its own</source>
        <translation>%1 kendi satırında yer alır</translation>
    </message>
    <message>
        <source>P without X Y Z is the weight of the first control point</source>
        <translation>X Y Z olmadan P ilk kontrol noktasının ağırlığıdır</translation>
    </message>
    <message>
        <source>a NURBS has %1 control points at most</source>
        <translation>bir NURBS&apos;ün en çok %1 kontrol noktası olur</translation>
    </message>
    <message>
        <source>a NURBS of order %1 needs as many points, and has %2</source>
        <translation>%1. dereceden bir NURBS o kadar nokta ister, %2 noktası var</translation>
    </message>
    <message>
        <source>a line with K alone came before: no more points can follow</source>
        <translation>önce yalnız K olan bir satır geldi: artık nokta gelemez</translation>
    </message>
    <message>
        <source>each line of G6.2 needs its knot K</source>
        <translation>G6.2&apos;nin her satırı düğümü K&apos;yi ister</translation>
    </message>
    <message>
        <source>the NURBS that G5.2 began has no end: write G5.3 before this line</source>
        <translation>G5.2 ile başlayan NURBS&apos;ün sonu yok: bu satırdan önce G5.3 yazın</translation>
    </message>
    <message>
        <source>the NURBS that G6.2 began has no end: as many lines with K alone as its order P come behind its points</source>
        <translation>G6.2 ile başlayan NURBS&apos;ün sonu yok: noktalarının ardından derecesi P kadar yalnız K olan satır gelir</translation>
    </message>
    <message>
        <source>the first control point of G6.2 must be where the tool stands</source>
        <translation>G6.2&apos;nin ilk kontrol noktası takımın durduğu yer olmalı</translation>
    </message>
    <message>
        <source>the knots K have to begin and end with as many equal ones as the order P, and to have fewer equal ones between</source>
        <translation>düğümler K derecesi P kadar eşit değerle başlayıp bitmeli, arada daha azı eşit olmalı</translation>
    </message>
    <message>
        <source>the knots K of a NURBS cannot fall</source>
        <translation>bir NURBS&apos;ün düğümleri K azalamaz</translation>
    </message>
    <message>
        <source>the line begins with no code and is passed over: %1</source>
        <translation>satır bir kodla başlamıyor ve atlanıyor: %1</translation>
    </message>
    <message>
        <source>the weight %1 of a control point is 0.000001 to 1000000</source>
        <translation>bir kontrol noktasının ağırlığı %1 0.000001 ile 1000000 arasındadır</translation>
    </message>
    <message>
        <source>there is no %1 in this text</source>
        <translation>bu metinde %1 yok</translation>
    </message>
    <message>
        <source>G-code, a line each</source>
        <translation>G-code, her satırda bir tane</translation>
    </message>
    <message>
        <source>a folder that cannot be read</source>
        <translation>okunamayan bir klasör</translation>
    </message>
    <message>
        <source>a name of 1 .. %1 letters, digits, -, . and _</source>
        <translation>1 .. %1 harf, rakam, -, . ve _ içeren bir ad</translation>
    </message>
    <message>
        <source>macros, a file each</source>
        <translation>makrolar, her biri bir dosya</translation>
    </message>
    <message>
        <source>more than %1 files</source>
        <translation>%1 dosyadan fazlası</translation>
    </message>
    <message>
        <source>more than 1 MiB of macros</source>
        <translation>1 MiB&apos;den fazla makro</translation>
    </message>
    <message>
        <source>no modal state is kept here: M70 or M73 keeps it, M71 forgets it</source>
        <translation>burada saklanan modal durum yok: M70 ya da M73 saklar, M71 unutur</translation>
    </message>
    <message>
        <source>with G95 the spindle&apos;s speed S comes before F</source>
        <translation>G95 ile iş milinin hızı S, F&apos;den önce gelir</translation>
    </message>
    <message>
        <source>the spline is too large</source>
        <translation>spline çok büyük</translation>
    </message>
    <message>
        <source>another jog is under way</source>
        <translation>başka bir manuel hareket sürüyor</translation>
    </message>
    <message>
        <source>%1 moves are waiting already</source>
        <translation>%1 hareket zaten sırada</translation>
    </message>
    <message>
        <source>it was busy itself</source>
        <translation>kendisi meşguldü</translation>
    </message>
    <message>
        <source>it waited for the disk (%1 pages)</source>
        <translation>diski bekledi (%1 sayfa)</translation>
    </message>
    <message>
        <source>other programs had the processor</source>
        <translation>işlemci başka programlardaydı</translation>
    </message>
    <message>
        <source>it was stopped, or the computer was</source>
        <translation>durdurulmuştu ya da bilgisayar durmuştu</translation>
    </message>
    <message>
        <source>%1; it has no real-time priority</source>
        <translation>%1; gerçek zaman önceliği yok</translation>
    </message>
    <message>
        <source>the gateway is back: the job goes on by itself</source>
        <translation>ağ geçidi geri geldi: iş kendiliğinden sürüyor</translation>
    </message>
    <message>
        <source>the gateway did not run for %1 s: %2</source>
        <translation>ağ geçidi %1 s çalışmadı: %2</translation>
    </message>
    <message>
        <source>the gateway was away %1 times: the job waits for a person</source>
        <translation>ağ geçidi %1 kez uzakta kaldı: iş birini bekliyor</translation>
    </message>
    <message>
        <source>run_current_ma, %1, to 5000</source>
        <translation>run_current_ma, %1, ile 5000 arası</translation>
    </message>
    <message>
        <source>%1 has no effect in a job: run_current_ma and hold_current_ma of [joint.NAME] in the machine file say what a motor gets; M906 on the console or of a print host sets it</source>
        <translation>%1 bir iş içinde etkisizdir: bir motorun aldığı akımı makine dosyasındaki [joint.NAME] run_current_ma ve hold_current_ma belirler; konsoldan ya da baskı programından gelen M906 onu ayarlar</translation>
    </message>
    <message>
        <source>set a motor&apos;s currents</source>
        <translation>bir motorun akımlarını ayarlama</translation>
    </message>
    <message>
        <source>measure a motor</source>
        <translation>bir motoru ölçme</translation>
    </message>
    <message>
        <source>cannot %1 while a motor is measured (%2)</source>
        <translation>bir motor ölçülürken (%2) yapılamaz: %1</translation>
    </message>
    <message>
        <source>there is no joint %1: they are 1 to %2</source>
        <translation>%1 numaralı eklem yok: numaralar 1 ile %2 arası</translation>
    </message>
    <message>
        <source>one motor alone goes at most 20 mm or 30 degrees: the others hold the tool</source>
        <translation>tek bir motor en çok 20 mm ya da 30 derece gider: takımı ötekiler tutar</translation>
    </message>
    <message>
        <source>%1 cannot move alone here</source>
        <translation>%1 burada tek başına hareket edemez</translation>
    </message>
    <message>
        <source>it is simulated: only a heater on a heat node can be measured</source>
        <translation>o benzetilmiş: yalnızca bir ısı düğümündeki ısıtıcı ölçülebilir</translation>
    </message>
    <message>
        <source>it was ended before it was done</source>
        <translation>bitmeden sonlandırıldı</translation>
    </message>
    <message>
        <source>its node was not in operation any more: measure it again</source>
        <translation>düğümü artık çalışmıyordu: yeniden ölçün</translation>
    </message>
    <message>
        <source>the way to the temperature is too short to measure anything: let it cool first</source>
        <translation>sıcaklığa kalan yol bir şey ölçmek için çok kısa: önce soğumasını bekleyin</translation>
    </message>
    <message>
        <source>full power does not warm its sensor: look whether heater and sensor are plugged in, and in their places</source>
        <translation>tam güç algılayıcısını ısıtmıyor: ısıtıcı ile algılayıcının takılı ve yerinde olup olmadığına bakın</translation>
    </message>
    <message>
        <source>it was not half the way up after 20 minutes: choose a lower temperature, or look at its supply and its power</source>
        <translation>20 dakika sonra yolun yarısına gelmemişti: daha düşük bir sıcaklık seçin ya da beslemesine ve gücüne bakın</translation>
    </message>
    <message>
        <source>it would have gone above its limit: choose a lower temperature</source>
        <translation>sınırını aşacaktı: daha düşük bir sıcaklık seçin</translation>
    </message>
    <message>
        <source>its curve is not that of a heater: look for a loose heater or sensor, a fan or a draught, then measure again</source>
        <translation>eğrisi bir ısıtıcının eğrisi değil: gevşek ısıtıcı veya algılayıcı, fan ya da hava akımı arayın, sonra yeniden ölçün</translation>
    </message>
    <message>
        <source>its node gives no reason</source>
        <translation>düğümü neden bildirmiyor</translation>
    </message>
    <message>
        <source>its node refuses to measure it: %1</source>
        <translation>düğümü onu ölçmeyi reddediyor: %1</translation>
    </message>
    <message>
        <source>its node has ended it: see its alarms, or measure it again</source>
        <translation>düğümü sonlandırdı: alarmlarına bakın ya da yeniden ölçün</translation>
    </message>
    <message>
        <source>its node did not store it, and forgets it without power: %1</source>
        <translation>düğümü bunu saklamadı, elektrik kesilince unutur: %1</translation>
    </message>
    <message>
        <source>its node does not answer: %1</source>
        <translation>düğümü yanıt vermiyor: %1</translation>
    </message>
    <message>
        <source>M303 measures a heater, which no job does: write it on the console or send it from a print host while nothing runs</source>
        <translation>M303 bir ısıtıcıyı ölçer, bunu hiçbir iş yapmaz: hiçbir şey çalışmazken konsola yazın veya yazdırma programından gönderin</translation>
    </message>
    <message>
        <source>measure a heater</source>
        <translation>bir ısıtıcıyı ölçme</translation>
    </message>
    <message>
        <source>cannot %1 while heater.%2 is measured: a target of 0 ends that</source>
        <translation>heater.%2 (ısıtıcı) ölçülürken yapılamaz: %1; hedef 0 ölçümü bitirir</translation>
    </message>
    <message>
        <source>an interrupted job waits: cancel it, or resume it, before a heater is measured</source>
        <translation>yarıda kalmış bir iş bekliyor: bir ısıtıcı ölçülmeden önce onu iptal edin veya sürdürün</translation>
    </message>
    <message>
        <source>%1 is measured, to be good at %2 C: full power for half of the way</source>
        <translation>%1 ölçülüyor, %2 °C için: yolun yarısına kadar tam güç</translation>
    </message>
    <message>
        <source>%1: the power is off, its curve is followed</source>
        <translation>%1: güç kapalı, eğrisi izleniyor</translation>
    </message>
    <message>
        <source>%1 was not measured: %2</source>
        <translation>%1 ölçülemedi: %2</translation>
    </message>
    <message>
        <source>%1: at %2 W it has %3 J/K, a dead time of %4 s, a lag of %5 s, and loses %6 W/K</source>
        <translation>%1: %2 W güçle %3 J/K, ölü zaman %4 s, gecikme %5 s, kayıp %6 W/K</translation>
    </message>
    <message>
        <source>M303 names a heater by a whole number: E0 or H1 the first hot end, E-1 or H0 the bed</source>
        <translation>M303 ısıtıcıyı tam sayıyla adlandırır: E0 veya H1 ilk nozul, E-1 veya H0 tabla</translation>
    </message>
    <message>
        <source>heater.%1 is being measured: a target of 0 ends that</source>
        <translation>heater.%1 (ısıtıcı) ölçülüyor: hedef 0 bunu bitirir</translation>
    </message>
    <message>
        <source>a heater is measured while all are off: switch them off first</source>
        <translation>bir ısıtıcı hepsi kapalıyken ölçülür: önce hepsini kapatın</translation>
    </message>
    <message>
        <source>%1 is at %2 C: from there to %3 C it is less than the %4 K that a measurement needs; let it cool, or choose a higher temperature</source>
        <translation>%1 şu anda %2 °C: oradan %3 °C değerine, ölçümün gerektirdiği %4 K&apos;den az; soğumasını bekleyin veya daha yüksek bir sıcaklık seçin</translation>
    </message>
    <message>
        <source>M906 takes letters with numbers, as M906 X800 H400 or M906 I1 S800</source>
        <translation>M906 sayılı harfler alır: M906 X800 H400 ya da M906 I1 S800 gibi</translation>
    </message>
    <message>
        <source>no motor moves %1 alone on this machine: name a joint by its number, as M906 I1 S800 for %2</source>
        <translation>bu makinede hiçbir motor yalnız %1 yönünü hareket ettirmez: bir eklemi numarasıyla söyleyin, örneğin %2 için M906 I1 S800</translation>
    </message>
    <message>
        <source>I is the number of a joint, 1 to %1</source>
        <translation>I bir eklemin numarasıdır, 1 ile %1 arası</translation>
    </message>
    <message>
        <source>M906 I needs the run current S or the hold current H</source>
        <translation>M906 I, çalışma akımı S ya da tutma akımı H ister</translation>
    </message>
    <message>
        <source>S and H need the joint I</source>
        <translation>S ve H, eklem I ister</translation>
    </message>
    <message>
        <source>M906 takes axes or the joint I, not both</source>
        <translation>M906 ya eksenleri ya eklem I alır, ikisini birden değil</translation>
    </message>
    <message>
        <source>no motor is named</source>
        <translation>hiçbir motor belirtilmedi</translation>
    </message>
    <message>
        <source>%1: a run current is 50 to %2 mA; max_current_ma of [joint.%3] in the machine file says how much the motor bears</source>
        <translation>%1: çalışma akımı 50 ile %2 mA arasıdır; motorun ne kadarına dayandığını makine dosyasındaki [joint.%3] max_current_ma söyler</translation>
    </message>
    <message>
        <source>%1: a hold current is 0 to the run current, %2 mA</source>
        <translation>%1: tutma akımı 0 ile çalışma akımı, %2 mA, arasıdır</translation>
    </message>
    <message>
        <source>the measurement failed: is a motor connected?</source>
        <translation>ölçüm başarısız oldu: bir motor bağlı mı?</translation>
    </message>
    <message>
        <source>this node measures no currents</source>
        <translation>bu düğüm akım ölçmüyor</translation>
    </message>
    <message>
        <source>the measurement does not end</source>
        <translation>ölçüm bitmiyor</translation>
    </message>
    <message>
        <source>%1: measured %2 Ohm, %3 mH, encoder offset %4: resistance_ohm, inductance_mh and encoder_offset_counts of [joint.%5.motor] in the machine file keep them</source>
        <translation>%1: ölçülen %2 Ohm, %3 mH, kodlayıcı kayması %4: bunları makine dosyasındaki [joint.%5.motor] resistance_ohm, inductance_mh ve encoder_offset_counts saklar</translation>
    </message>
    <message>
        <source>%1: run current %2 mA, hold current %3 mA</source>
        <translation>%1: çalışma akımı %2 mA, tutma akımı %3 mA</translation>
    </message>
    <message>
        <source>no lines are open</source>
        <translation>açık satır akışı yok</translation>
    </message>
    <message>
        <source>move</source>
        <translation>hareket</translation>
    </message>
    <message>
        <source>the feed is as programmed again</source>
        <translation>ilerleme hızı yeniden programdaki gibi</translation>
    </message>
    <message>
        <source>on the way back to the job&apos;s place %1: move the tool clear by hand, then resume</source>
        <translation>işin kaldığı yere dönerken %1: takımı elle uzaklaştırın, sonra sürdürün</translation>
    </message>
    <message>
        <source>%1: what was printed is taken to stand on the table until the next job begins, or the machine is homed with no job interrupted</source>
        <translation>%1: basılanın, sonraki iş başlayana ya da kesilmiş iş yokken makine referansa gidene kadar tablada durduğu varsayılır</translation>
    </message>
    <message>
        <source>frames reach %1 in another order than they were sent; it puts them right. A USB adapter does that: gs_usb keeps the order from Linux 6.6 on, candleLight&apos;s firmware from 2.0 on</source>
        <translation>çerçeveler %1 için gönderildiklerinden başka bir sırayla varıyor; sıralarını kendisi düzeltiyor. Bunu bir USB bağdaştırıcısı yapar: gs_usb sırayı Linux 6.6&apos;dan, candleLight yazılımı 2.0&apos;dan beri korur</translation>
    </message>
    <message>
        <source>%1 cannot stand while cutter compensation is on: end it with G40 first</source>
        <translation>kesici telafisi açıkken %1 kullanılamaz: önce G40 ile bitirin</translation>
    </message>
    <message>
        <source>more than %1 lines without a move in the plane while cutter compensation is on</source>
        <translation>kesici telafisi açıkken düzlemde hareketi olmayan %1 satırdan fazlası var</translation>
    </message>
    <message>
        <source>the arc&apos;s radius of %1 is not greater than the tool&apos;s, %2, on its inside</source>
        <translation>yayın %1 olan yarıçapı, iç tarafında takımın yarıçapından (%2) büyük değil</translation>
    </message>
    <message>
        <source>the lead-in is too tight: the arc&apos;s radius of %1 is not greater than the tool&apos;s, %2</source>
        <translation>giriş hareketi çok dar: yayın %1 olan yarıçapı takımınkinden (%2) büyük değil</translation>
    </message>
    <message>
        <source>the lead-in is too short: the first move is %1 long, not more than the tool&apos;s radius, %2</source>
        <translation>giriş hareketi çok kısa: ilk hareket %1 uzunluğunda, takımın yarıçapından (%2) uzun değil</translation>
    </message>
    <message>
        <source>no lead-in arc of this direction leads from here to beside the path</source>
        <translation>buradan yolun yanına bu yönde bir giriş yayı götürmüyor</translation>
    </message>
    <message>
        <source>the tool, of radius %1, does not come into the inside corner between line %2 and this one without cutting into them</source>
        <translation>yarıçapı %1 olan takım, satır %2 ile bu satır arasındaki iç köşeye onları kesmeden giremiyor</translation>
    </message>
    <message>
        <source>the tool would cut into line %1 on its way along line %2</source>
        <translation>takım, satır %2 boyunca giderken satır %1 yolunu keserdi</translation>
    </message>
    <message>
        <source>after G40 a straight move (G0, G1) comes first: %1 cannot stand here</source>
        <translation>G40&apos;tan sonra önce düz bir hareket (G0, G1) gelir: %1 burada kullanılamaz</translation>
    </message>
    <message>
        <source>%1 needs D, the tool&apos;s diameter</source>
        <translation>%1 için D, takımın çapı, gerekir</translation>
    </message>
    <message>
        <source>the diameter of T%1 is not known: write gcode.tool_diameter_mm in the machine file, or G41.1 D with the diameter</source>
        <translation>T%1 takımının çapı bilinmiyor: makine dosyasına gcode.tool_diameter_mm yazın, ya da çapı G41.1 D ile verin</translation>
    </message>
    <message>
        <source>the tool does not stand upright on the plane of %1: turn it with G53.1 first</source>
        <translation>takım %1 düzlemine dik durmuyor: önce G53.1 ile döndürün</translation>
    </message>
    <message>
        <source>cutter compensation belongs to a job: it looks ahead, which single lines cannot</source>
        <translation>kesici telafisi bir işe aittir: ileriye bakar, tek satırlarla bu olmaz</translation>
    </message>
    <message>
        <source>a node that has axes: it latches where they were</source>
        <translation>eksenleri olan bir düğüm: onların nerede olduğunu yakalar</translation>
    </message>
    <message>
        <source>%1 needs a decimal: G38.2 to G38.5</source>
        <translation>%1 ondalık ister: G38.2 ile G38.5 arası</translation>
    </message>
    <message>
        <source>%1 needs a probe: the machine file has no [probe]</source>
        <translation>%1 bir prob ister: makine dosyasında [probe] yok</translation>
    </message>
    <message>
        <source>%1 needs a probe that can touch: the machine file&apos;s has where = &quot;simulated&quot;; one on a node probes, on a virtual one, too</source>
        <translation>%1 dokunabilen bir prob ister: makine dosyasındaki where = &quot;simulated&quot;; bir düğümdeki prob ölçer, sanal düğümdeki de</translation>
    </message>
    <message>
        <source>%1 needs a feed for each minute: G94</source>
        <translation>%1 dakika başına ilerleme ister: G94</translation>
    </message>
    <message>
        <source>%1 cannot be used in a tilted plane: end it with G69 first</source>
        <translation>%1 eğik düzlemde kullanılamaz: önce G69 ile bitirin</translation>
    </message>
    <message>
        <source>%1 cannot be used while an object is left out</source>
        <translation>bir nesne atlanırken %1 kullanılamaz</translation>
    </message>
    <message>
        <source>probing goes at %1 mm/s: faster is not allowed by probe.speed_mm_per_s</source>
        <translation>problama %1 mm/s ile gider: probe.speed_mm_per_s daha hızlısına izin vermez</translation>
    </message>
    <message>
        <source>%1 moves X, Y and Z alone</source>
        <translation>%1 yalnız X, Y ve Z&apos;yi hareket ettirir</translation>
    </message>
    <message>
        <source>%1 with a probe beside the tool (probe.offset_mm) needs A and C at 0</source>
        <translation>takımın yanındaki probla (probe.offset_mm) %1, A ve C&apos;nin 0 olmasını ister</translation>
    </message>
    <message>
        <source>%1 needs X, Y or Z of a place that is not where the tool stands</source>
        <translation>%1, takımın durduğu yerden başka bir yerin X, Y ya da Z&apos;sini ister</translation>
    </message>
    <message>
        <source>the job probes here: what follows is checked as if the probe touched at the table, or at the end of its move, and again with what is measured, just before it moves</source>
        <translation>iş burada problama yapar: ardından gelen, prob tablada ya da hareketinin sonunda dokunmuş gibi kontrol edilir, ölçülenle de hareketten hemen önce yeniden</translation>
    </message>
    <message>
        <source>a macro or loop that probes works in a job, not as a line: the lines behind G38 have to know what it measures</source>
        <translation>problama yapan makro ya da döngü işte çalışır, tek satır olarak değil: G38&apos;den sonraki satırlar ölçüleni bilmelidir</translation>
    </message>
    <message>
        <source>a node has lost its position</source>
        <translation>bir düğüm konumunu yitirdi</translation>
    </message>
    <message>
        <source>the job ends: it was stopped while it probed</source>
        <translation>iş bitiyor: problama sırasında durduruldu</translation>
    </message>
    <message>
        <source>probing</source>
        <translation>problama</translation>
    </message>
    <message>
        <source>the machine has no probe</source>
        <translation>makinenin probu yok</translation>
    </message>
    <message>
        <source>the probe touches nothing, so that it cannot let go: nothing has moved</source>
        <translation>prob hiçbir şeye dokunmuyor, bu yüzden bırakamaz: hiçbir şey hareket etmedi</translation>
    </message>
    <message>
        <source>the probe touches before its move: nothing has moved</source>
        <translation>prob hareketinden önce dokunuyor: hiçbir şey hareket etmedi</translation>
    </message>
    <message>
        <source>the probe has not let go before the end of its move</source>
        <translation>prob hareketinin sonuna dek bırakmadı</translation>
    </message>
    <message>
        <source>the probe has not touched before the end of its move</source>
        <translation>prob hareketinin sonuna dek dokunmadı</translation>
    </message>
    <message>
        <source>the probe&apos;s node does not answer</source>
        <translation>probun düğümü yanıt vermiyor</translation>
    </message>
    <message>
        <source>a pin</source>
        <translation>bir pim</translation>
    </message>
    <message>
        <source>a probe on an input of a node, [probe] with where = &quot;node&quot;: its line</source>
        <translation>bir düğümün girişindeki bir prob, where = &quot;node&quot; olan [probe]: onun hattı</translation>
    </message>
    <message>
        <source>a heat node that has its table, [node.%1], with axis_pairs = 0</source>
        <translation>tablosu olan bir ısı düğümü, axis_pairs = 0 ile [node.%1]</translation>
    </message>
    <message>
        <source>node %1, which moves the probe&apos;s pin, is not in operation</source>
        <translation>probun pimini hareket ettiren düğüm %1 çalışmıyor</translation>
    </message>
    <message>
        <source>node %1 refuses to move the probe&apos;s pin: %2</source>
        <translation>düğüm %1 probun pimini hareket ettirmeyi reddediyor: %2</translation>
    </message>
    <message>
        <source>the probe&apos;s pin has not come out</source>
        <translation>probun pimi dışarı çıkmadı</translation>
    </message>
    <message>
        <source>the probe&apos;s pin has not gone in: look at it before anything moves</source>
        <translation>probun pimi içeri girmedi: herhangi bir şey hareket etmeden önce ona bakın</translation>
    </message>
    <message>
        <source>the probe is in alarm, after a reset, too: look at its pin before anything moves</source>
        <translation>prob sıfırlamadan sonra da alarmda: herhangi bir şey hareket etmeden önce pimine bakın</translation>
    </message>
    <message>
        <source>node %1 does not say where the probe&apos;s pin is</source>
        <translation>düğüm %1 probun piminin nerede olduğunu bildirmiyor</translation>
    </message>
    <message>
        <source>putting the probe&apos;s pin out</source>
        <translation>probun pimi çıkarılıyor</translation>
    </message>
    <message>
        <source>drawing the probe&apos;s pin in</source>
        <translation>probun pimi içeri çekiliyor</translation>
    </message>
    <message>
        <source>the probe has told of a contact, and its node knows of none</source>
        <translation>prob bir temas bildirdi, düğümü ise hiçbirini bilmiyor</translation>
    </message>
    <message>
        <source>the probe has touched at a time that is not one of its move</source>
        <translation>prob, hareketine ait olmayan bir anda dokundu</translation>
    </message>
    <message>
        <source>%1 has no effect: the machine file has no [probe]</source>
        <translation>%1 etkisiz: makine dosyasında [probe] yok</translation>
    </message>
    <message>
        <source>%1 has no effect: a probe with where = &quot;simulated&quot; cannot touch</source>
        <translation>%1 etkisiz: where = &quot;simulated&quot; olan prob dokunamaz</translation>
    </message>
    <message>
        <source>a mesh&apos;s name has %1 letters at most</source>
        <translation>bir tabla ağının adı en çok %1 harftir</translation>
    </message>
    <message>
        <source>%1 needs A and C at 0</source>
        <translation>%1 için A ve C 0 olmalı</translation>
    </message>
    <message>
        <source>the area to be probed lies outside of [mesh] of the machine file: %1 is %2 to %3 mm</source>
        <translation>ölçülecek alan makine dosyasındaki [mesh] dışında: %1, %2 ile %3 mm arası</translation>
    </message>
    <message>
        <source>a mesh has 2 to %1 points along an axis</source>
        <translation>bir tabla ağının bir eksen boyunca 2 ile %1 arası noktası olur</translation>
    </message>
    <message>
        <source>%1 of this form has no effect: G29 alone, or P1, probes the whole bed</source>
        <translation>%1 bu biçimde etkisiz: yalnız G29 ya da P1 bütün tablayı ölçer</translation>
    </message>
    <message>
        <source>M421 needs the point I J, counted from 0, and its height Z, or Q to add to it</source>
        <translation>M421, 0&apos;dan sayılan I J noktasını ve yüksekliği Z&apos;yi ya da eklenecek Q&apos;yu ister</translation>
    </message>
    <message>
        <source>the height over which a mesh fades cannot be negative</source>
        <translation>bir tabla ağının söndüğü yükseklik eksi olamaz</translation>
    </message>
    <message>
        <source>a bed mesh is put in force here: what follows is checked with the one in force now, and again just before it moves</source>
        <translation>burada bir tabla ağı yürürlüğe girer: sonrası şimdi yürürlükte olanla kontrol edilir, hareketten hemen önce de yeniden</translation>
    </message>
    <message>
        <source>the bed is measured when the machine is ready: bring up and home it first</source>
        <translation>tabla, makine hazırken ölçülür: önce makineyi devreye alın ve referansa götürün</translation>
    </message>
    <message>
        <source>a job is under way: the bed mesh stays as it is</source>
        <translation>bir iş sürüyor: tabla ağı olduğu gibi kalır</translation>
    </message>
    <message>
        <source>the bed mesh %1 was measured with another geometry of the machine: it is not used, measure the bed again</source>
        <translation>%1 tabla ağı makinenin başka bir geometrisiyle ölçülmüş: kullanılmıyor, tablayı yeniden ölçün</translation>
    </message>
    <message>
        <source>the bed is %1 to %2 mm from the table of the machine file; mesh.limit_mm allows %3 mm: level it, or correct the machine file</source>
        <translation>tabla, makine dosyasındaki tabladan %1 ile %2 mm arası sapıyor; mesh.limit_mm %3 mm&apos;ye izin verir: tablayı tesviye edin ya da makine dosyasını düzeltin</translation>
    </message>
    <message>
        <source>a mesh of up to %1 mm has to fade over at least %2 mm: found %3</source>
        <translation>%1 mm&apos;ye varan bir tabla ağı en az %2 mm boyunca sönmeli: bulunan %3</translation>
    </message>
    <message>
        <source>there is no mesh %1</source>
        <translation>%1 adlı tabla ağı yok</translation>
    </message>
    <message>
        <source>Bed X: %1 Y: %2 Z: %3</source>
        <translation>Tabla X: %1 Y: %2 Z: %3</translation>
    </message>
    <message>
        <source>no bed mesh is in force</source>
        <translation>yürürlükte tabla ağı yok</translation>
    </message>
    <message>
        <source>the mesh in force has %1 x %2 points</source>
        <translation>yürürlükteki tabla ağının %1 x %2 noktası var</translation>
    </message>
    <message>
        <source>no bed mesh is kept: the bed is taken as even</source>
        <translation>saklanmış tabla ağı yok: tabla düz sayılıyor</translation>
    </message>
    <message>
        <source>the bed was not measured as a whole</source>
        <translation>tablanın tamamı ölçülmedi</translation>
    </message>
    <message>
        <source>bed mesh %1: %2 x %3 points, %4 to %5 mm</source>
        <translation>tabla ağı %1: %2 x %3 nokta, %4 ile %5 mm arası</translation>
    </message>
    <message>
        <source>the tool&apos;s place cannot be named</source>
        <translation>takımın yeri adlandırılamıyor</translation>
    </message>
    <message>
        <source>echo writes no files here: it tells the operator</source>
        <translation>echo burada dosya yazmaz: operatöre bildirir</translation>
    </message>
    <message>
        <source>the text is too long (500 letters at most)</source>
        <translation>metin çok uzun (en çok 500 harf)</translation>
    </message>
    <message>
        <source>expected an operator or %1</source>
        <translation>işleç ya da %1 bekleniyordu</translation>
    </message>
    <message>
        <source>the job aborts itself here</source>
        <translation>iş burada kendini durduruyor</translation>
    </message>
    <message>
        <source>the job aborts itself here: %1</source>
        <translation>iş burada kendini durduruyor: %1</translation>
    </message>
    <message>
        <source>set changes var.NAME or global.NAME</source>
        <translation>set, var.NAME ya da global.NAME değerini değiştirir</translation>
    </message>
    <message>
        <source>expected %1</source>
        <translation>beklenen: %1</translation>
    </message>
    <message>
        <source>nothing can follow the value</source>
        <translation>değerden sonra bir şey gelemez</translation>
    </message>
    <message>
        <source>%1 has no value yet</source>
        <translation>%1 henüz değer almadı</translation>
    </message>
    <message>
        <source>%1 exists already: set changes it</source>
        <translation>%1 zaten var: set onu değiştirir</translation>
    </message>
    <message>
        <source>too many variables (%1 at most)</source>
        <translation>çok fazla değişken var (en çok %1)</translation>
    </message>
    <message>
        <source>the arguments of a macro are letters with numbers</source>
        <translation>makro bağımsız değişkenleri sayılı harflerdir</translation>
    </message>
    <message>
        <source>no object can be left out while cutter compensation is on</source>
        <translation>kesici telafisi açıkken hiçbir nesne atlanamaz</translation>
    </message>
    <message>
        <source>if and while belong to a job: a single line can only call a macro</source>
        <translation>if ve while işe aittir: tek satır yalnız makro çağırabilir</translation>
    </message>
    <message>
        <source>%1 is in no loop</source>
        <translation>%1 bir döngüde değil</translation>
    </message>
    <message>
        <source>expected a number, not %1</source>
        <translation>sayı bekleniyordu, %1 değil</translation>
    </message>
    <message>
        <source>expected a condition (true or false), not %1</source>
        <translation>koşul (true ya da false) bekleniyordu, %1 değil</translation>
    </message>
    <message>
        <source>the index %1 is too large: there are %2</source>
        <translation>%1 dizini çok büyük: %2 tane var</translation>
    </message>
    <message>
        <source>%1 cannot be known when the text is read; what can: %2</source>
        <translation>metin okunurken %1 bilinemez; bilinebilenler: %2</translation>
    </message>
    <message>
        <source>expected a value</source>
        <translation>değer bekleniyordu</translation>
    </message>
    <message>
        <source># counts the letters of a text, or a list of the object model</source>
        <translation># bir metnin harflerini ya da nesne modelinin bir listesini sayar</translation>
    </message>
    <message>
        <source>the text needs a closing quotation mark</source>
        <translation>metnin kapanış tırnağı eksik</translation>
    </message>
    <message>
        <source>expected a name: letters, digits and _</source>
        <translation>ad bekleniyordu: harf, rakam ve _</translation>
    </message>
    <message>
        <source>the name is too long (64 letters at most)</source>
        <translation>ad çok uzun (en çok 64 harf)</translation>
    </message>
    <message>
        <source>an index is a whole number from 0</source>
        <translation>dizin 0 ya da daha büyük bir tam sayıdır</translation>
    </message>
    <message>
        <source>a function has 16 arguments at most</source>
        <translation>bir fonksiyonun en çok 16 bağımsız değişkeni olur</translation>
    </message>
    <message>
        <source>there is no function %1 of %2 values</source>
        <translation>%2 değerli bir %1 fonksiyonu yok</translation>
    </message>
    <message>
        <source>iterations has a value in a loop alone</source>
        <translation>iterations yalnız bir döngüde değer alır</translation>
    </message>
    <message>
        <source>the call gives no %1</source>
        <translation>çağrı %1 vermiyor</translation>
    </message>
    <message>
        <source>no job is read</source>
        <translation>okunan bir iş yok</translation>
    </message>
    <message>
        <source>leave an object out</source>
        <translation>bir nesneyi atlama</translation>
    </message>
    <message>
        <source>the job names no objects</source>
        <translation>iş hiçbir nesnenin adını vermiyor</translation>
    </message>
    <message>
        <source>the job has no object %1; it has %2</source>
        <translation>işte %1 nesnesi yok; olanlar: %2</translation>
    </message>
    <message>
        <source>the object %1 is left out from line %2 on: what is before it is planned already</source>
        <translation>%1 nesnesi %2. satırdan itibaren atlanıyor: öncesi zaten planlandı</translation>
    </message>
    <message>
        <source>while a job runs M486 takes P with the number of an object</source>
        <translation>iş çalışırken M486, bir nesnenin numarasıyla P alır</translation>
    </message>
    <message>
        <source>no job runs of which an object could be left out</source>
        <translation>nesnesi atlanabilecek çalışan bir iş yok</translation>
    </message>
    <message>
        <source>A motor phase is shorted to ground</source>
        <translation>Bir motor fazı toprağa kısa devre</translation>
    </message>
    <message>
        <source>a motor phase is shorted to ground</source>
        <translation>bir motor fazı toprağa kısa devre</translation>
    </message>
    <message>
        <source>A motor phase is shorted to the supply</source>
        <translation>Bir motor fazı beslemeye kısa devre</translation>
    </message>
    <message>
        <source>a motor phase is shorted to the supply</source>
        <translation>bir motor fazı beslemeye kısa devre</translation>
    </message>
    <message>
        <source>A motor driver has lost its settings</source>
        <translation>Bir motor sürücüsü ayarlarını kaybetti</translation>
    </message>
    <message>
        <source>a motor driver has lost its settings: its supply was gone</source>
        <translation>bir motor sürücüsü ayarlarını kaybetti: beslemesi kesilmişti</translation>
    </message>
    <message>
        <source>check the motor supply, then clear and home again</source>
        <translation>motor beslemesini kontrol edin, sonra alarmı kaldırıp yeniden referansa gönderin</translation>
    </message>
    <message>
        <source>A motor driver does not answer</source>
        <translation>Bir motor sürücüsü yanıt vermiyor</translation>
    </message>
    <message>
        <source>a motor driver does not answer by UART or SPI</source>
        <translation>bir motor sürücüsü UART veya SPI üzerinden yanıt vermiyor</translation>
    </message>
    <message>
        <source>check the motor supply, the driver&apos;s seat and its jumpers for UART or SPI, then clear</source>
        <translation>motor beslemesini, sürücünün yuvasına oturuşunu ve UART ya da SPI atlama tellerini kontrol edin, sonra alarmı kaldırın</translation>
    </message>
    <message>
        <source>an NMT command that does not carry the session&apos;s check value was refused (%1)</source>
        <translation>oturumun kontrol değerini taşımayan bir NMT komutu reddedildi (%1)</translation>
    </message>
    <message>
        <source>a write of object %1 that does not carry the session&apos;s check value was refused</source>
        <translation>%1 nesnesine oturumun kontrol değerini taşımayan bir yazma reddedildi</translation>
    </message>
    <message>
        <source>a change of the rate that does not carry the session&apos;s check value was refused</source>
        <translation>oturumun kontrol değerini taşımayan bir hız oranı değişikliği reddedildi</translation>
    </message>
    <message>
        <source>a controlword or set point that does not carry the session&apos;s check value was refused</source>
        <translation>oturumun kontrol değerini taşımayan bir kontrol sözcüğü veya ayar değeri reddedildi</translation>
    </message>
    <message>
        <source>a time stamp of SYNC that does not carry the session&apos;s check value was refused</source>
        <translation>oturumun kontrol değerini taşımayan bir SYNC zaman damgası reddedildi</translation>
    </message>
    <message>
        <source>while SYNC was silent its session was open, and a frame that nobody vouched for was obeyed (COB-ID %1)</source>
        <translation>SYNC sustuğu sürece oturumu açıktı ve kimsenin kefil olmadığı bir çerçeveye uyuldu (COB-ID %1)</translation>
    </message>
    <message>
        <source>A node has refused a frame of another device</source>
        <translation>Bir düğüm başka bir aygıtın çerçevesini reddetti</translation>
    </message>
    <message>
        <source>a frame without the session&apos;s check value was refused</source>
        <translation>oturumun kontrol değeri olmayan bir çerçeve reddedildi</translation>
    </message>
    <message>
        <source>the probe&apos;s pin is out</source>
        <translation>probun pimi dışarıda</translation>
    </message>
    <message>
        <source>the probe&apos;s pin is in</source>
        <translation>probun pimi içeride</translation>
    </message>
    <message>
        <source>the machine has no probe with a pin</source>
        <translation>makinede pimli prob yok</translation>
    </message>
    <message>
        <source>move the probe&apos;s pin</source>
        <translation>probun pimini hareket ettirme</translation>
    </message>
    <message>
        <source>M280 moves the probe&apos;s pin: S10 out, S90 in, S120 self test, S160 ends an alarm</source>
        <translation>M280 probun pimini hareket ettirir: S10 dışarı, S90 içeri, S120 kendini sınama, S160 bir alarmı bitirir</translation>
    </message>
    <message>
        <source>the machine has no accelerometer: [accelerometer] of the machine file names its node</source>
        <translation>makinede ivmeölçer yok: düğümünü makine dosyasının [accelerometer] tablosu belirtir</translation>
    </message>
    <message>
        <source>M956 S1 begins to measure, S0 ends it</source>
        <translation>M956 S1 ölçmeye başlar, S0 bitirir</translation>
    </message>
    <message>
        <source>a measurement begins while nothing runs</source>
        <translation>ölçüm, hiçbir şey çalışmıyorken başlar</translation>
    </message>
    <message>
        <source>nothing is measured: M956 S1 begins it</source>
        <translation>hiçbir şey ölçülmüyor: M956 S1 başlatır</translation>
    </message>
    <message>
        <source>its node has no accelerometer</source>
        <translation>düğümünde ivmeölçer yok</translation>
    </message>
    <message>
        <source>the accelerometer does not answer its node</source>
        <translation>ivmeölçer düğümüne yanıt vermiyor</translation>
    </message>
    <message>
        <source>it was too short: %1 s at least</source>
        <translation>çok kısaydı: en az %1 s</translation>
    </message>
    <message>
        <source>a code of a scale that tells no place</source>
        <translation>yer bildirmeyen bir cetvelin kodu</translation>
    </message>
    <message>
        <source>absolute_bits, or no gray_code</source>
        <translation>absolute_bits ya da gray_code yok</translation>
    </message>
    <message>
        <source>8 to 30 bits</source>
        <translation>8 ile 30 bit arası</translation>
    </message>
    <message>
        <source>an encoder and an absolute scale on one port</source>
        <translation>bir bağlantıda hem kodlayıcı hem mutlak cetvel</translation>
    </message>
    <message>
        <source>encoder = &quot;none&quot;, or a scale of pulses</source>
        <translation>encoder = &quot;none&quot; ya da darbe veren bir cetvel</translation>
    </message>
    <message>
        <source>a scale that begins anew every %1 mm</source>
        <translation>her %1 mm&apos;de yeniden başlayan bir cetvel</translation>
    </message>
    <message>
        <source>one that is at least %1 mm long at this speed</source>
        <translation>bu hızda en az %1 mm uzunluğunda olanı</translation>
    </message>
    <message>
        <source>set the job aside</source>
        <translation>işi kenara alma</translation>
    </message>
    <message>
        <source>move the filament</source>
        <translation>filamenti sürme</translation>
    </message>
    <message>
        <source>no job is held that could be set aside</source>
        <translation>kenara alınabilecek duraklatılmış bir iş yok</translation>
    </message>
    <message>
        <source>the tool is on its way: resume or cancel first</source>
        <translation>takım yolda: önce sürdürün ya da iptal edin</translation>
    </message>
    <message>
        <source>the probe is on its way: resume or cancel first</source>
        <translation>prob yolda: önce sürdürün ya da iptal edin</translation>
    </message>
    <message>
        <source>the tool is not parked: %1</source>
        <translation>takım park edilmedi: %1</translation>
    </message>
    <message>
        <source>change the filament: load, purge, then resume goes on with the job</source>
        <translation>filamenti değiştirin: yükleyin, akıtın, sonra sürdürün; iş devam eder</translation>
    </message>
    <message>
        <source>the job is set aside: jog, heat and extrude, then resume goes on with it</source>
        <translation>iş kenara alındı: manuel hareket, ısıtma ve ekstrüzyon serbest; sonra sürdürün, iş devam eder</translation>
    </message>
    <message>
        <source>nothing here feeds filament</source>
        <translation>burada filament süren bir şey yok</translation>
    </message>
    <message>
        <source>%1 is 0 in the machine file</source>
        <translation>%1 makine dosyasında 0</translation>
    </message>
    <message>
        <source>this gateway cannot be started anew from here</source>
        <translation>bu ağ geçidi buradan yeniden başlatılamaz</translation>
    </message>
    <message>
        <source>the gateway starts anew when the machine rests and no job is under way or interrupted</source>
        <translation>ağ geçidi, makine dururken ve süren ya da kesilmiş bir iş yokken yeniden başlar</translation>
    </message>
    <message>
        <source>false: that converter measures pt100 and pt1000</source>
        <translation>false: o çevirici pt100 ve pt1000 ölçer</translation>
    </message>
    <message>
        <source>50 or 60</source>
        <translation>50 veya 60</translation>
    </message>
    <message>
        <source>%1 at %2 C</source>
        <translation>%2 C’de %1</translation>
    </message>
    <message>
        <source>a resistance that falls all the way as it gets hotter</source>
        <translation>ısındıkça baştan sona azalan bir direnç</translation>
    </message>
    <message>
        <source>at most %1, which its sensor is made for</source>
        <translation>en çok %1; algılayıcısı bunun için yapılmıştır</translation>
    </message>
    <message>
        <source>at most %1: with limit_c, %2 above it, its sensor is made for no more</source>
        <translation>en çok %1: onun %2 üstündeki limit_c ile birlikte algılayıcısı daha fazlası için yapılmamıştır</translation>
    </message>
    <message>
        <source>%1 was never measured: a heater or sensor that has slipped half out of its hole may stay unseen. Measure it: tune, or M303</source>
        <translation>%1 hiç ölçülmedi: yuvasından yarı çıkmış bir ısıtıcı ya da algılayıcı fark edilmeyebilir. Ölçün: ayarla, ya da M303</translation>
    </message>
    <message>
        <source>an address http://HOST/PATH, https://HOST/PATH or, on this computer, :PORT/PATH</source>
        <translation>bir adres: http://MAKİNE/YOL, https://MAKİNE/YOL ya da bu bilgisayarda :KAPI/YOL</translation>
    </message>
    <message>
        <source>10 to 1000: 110 on most modules, 75 with a TMC5160</source>
        <translation>10..1000: çoğu modülde 110, TMC5160 ile 75</translation>
    </message>
    <message>
        <source>homing by the load of a driver that nobody speaks to</source>
        <translation>kimsenin konuşmadığı bir sürücünün yüküyle referans alma</translation>
    </message>
    <message>
        <source>a method of 17..22 or 37, or no stands_alone</source>
        <translation>17..22 ya da 37 yöntemi, ya da stands_alone olmadan</translation>
    </message>
    <message>
        <source>settings for a driver that nobody speaks to</source>
        <translation>kimsenin konuşmadığı bir sürücü için ayarlar</translation>
    </message>
    <message>
        <source>stands_alone alone, or without it</source>
        <translation>yalnız stands_alone, ya da o olmadan</translation>
    </message>
    <message>
        <source>a driver behind step and direction, and a motor that the node drives itself</source>
        <translation>adım ve yön arkasında bir sürücü ve düğümün kendisinin sürdüğü bir motor</translation>
    </message>
    <message>
        <source>one of the two tables</source>
        <translation>iki tablodan biri</translation>
    </message>
    <message>
        <source>two nodes use the id %1: one says that it is operational, the other that it is not</source>
        <translation>iki düğüm %1 kimliğini kullanıyor: biri çalışır durumda olduğunu söylüyor, öteki olmadığını</translation>
    </message>
</context>
<context>
    <name>GatewayWords</name>
    <message>
        <source>expected %1</source>
        <translation>beklenen: %1</translation>
    </message>
</context>
<context>
    <name>StateWords</name>
    <message>
        <source>Motors off</source>
        <translation>Motorlar kapalı</translation>
    </message>
    <message>
        <source>Waking the nodes</source>
        <translation>Düğümler uyandırılıyor</translation>
    </message>
    <message>
        <source>Not homed</source>
        <translation>Referansa gidilmedi</translation>
    </message>
    <message>
        <source>Homing</source>
        <translation>Referansa gidiyor</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Hazır</translation>
    </message>
    <message>
        <source>Moving</source>
        <translation>Hareket ediyor</translation>
    </message>
    <message>
        <source>Checking the job</source>
        <translation>İş kontrol ediliyor</translation>
    </message>
    <message>
        <source>Printing</source>
        <translation>Basıyor</translation>
    </message>
    <message>
        <source>Pausing</source>
        <translation>Duraklıyor</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>Duraklatıldı</translation>
    </message>
    <message>
        <source>Cancelling</source>
        <translation>İptal ediliyor</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Duruyor</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Durdu</translation>
    </message>
    <message>
        <source>Alarm</source>
        <translation>Alarm</translation>
    </message>
    <message>
        <source>Unknown</source>
        <translation>Bilinmiyor</translation>
    </message>
    <message>
        <source>Home the machine to wake the motors and find the carriages.</source>
        <translation>Motorları uyandırmak ve taşıyıcıları bulmak için makineyi referansa gönderin.</translation>
    </message>
    <message>
        <source>Home the machine: positions are not known yet.</source>
        <translation>Makineyi referansa gönderin: konumlar henüz bilinmiyor.</translation>
    </message>
    <message>
        <source>Choose a job and start it, or jog the tool.</source>
        <translation>Bir iş seçip başlatın ya da takımı manuel hareket ettirin.</translation>
    </message>
    <message>
        <source>All carriages rest on the path. Resume or cancel.</source>
        <translation>Bütün taşıyıcılar yol üzerinde duruyor. Sürdürün ya da iptal edin.</translation>
    </message>
    <message>
        <source>Make sure that the machine is safe, then clear the stop.</source>
        <translation>Makinenin güvenli olduğundan emin olun, sonra durdurmayı kaldırın.</translation>
    </message>
    <message>
        <source>Read the alarm, remove its cause, then clear it.</source>
        <translation>Alarmı okuyun, nedenini giderin, sonra kaldırın.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::AlarmsPage</name>
    <message>
        <source>Clear</source>
        <translation>Kaldır</translation>
    </message>
    <message>
        <source>No alarm is open.</source>
        <translation>Açık alarm yok.</translation>
    </message>
    <message>
        <source>What has happened, newest first</source>
        <translation>Olanlar, en yenisi önce</translation>
    </message>
    <message>
        <source>Messages, too</source>
        <translation>İletiler de</translation>
    </message>
    <message>
        <source>No alarms so far.</source>
        <translation>Şimdiye kadar alarm yok.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::AxesModel</name>
    <message>
        <source>Axis</source>
        <translation>Eksen</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>Konum</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>Ölçülen</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Hata</translation>
    </message>
    <message>
        <source>By scale</source>
        <translation>Cetvelle</translation>
    </message>
    <message>
        <source>Error by scale</source>
        <translation>Cetvelle hata</translation>
    </message>
    <message>
        <source>%1 µm</source>
        <translation>%1 µm</translation>
    </message>
    <message>
        <source>Travel</source>
        <translation>Strok</translation>
    </message>
    <message>
        <source>Current</source>
        <translation>Akım</translation>
    </message>
    <message>
        <source>Drive</source>
        <translation>Sürücü</translation>
    </message>
    <message>
        <source>Switch</source>
        <translation>Anahtar</translation>
    </message>
    <message>
        <source>Node</source>
        <translation>Düğüm</translation>
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
        <translation>Arıza</translation>
    </message>
    <message>
        <source>On</source>
        <translation>Açık</translation>
    </message>
    <message>
        <source>Off</source>
        <translation>Kapalı</translation>
    </message>
    <message>
        <source>Hit</source>
        <translation>Basılı</translation>
    </message>
    <message>
        <source>Free</source>
        <translation>Serbest</translation>
    </message>
    <message>
        <source>Counts</source>
        <translation>Sayım</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>Çalışma</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>Tutma</translation>
    </message>
    <message>
        <source>Stage</source>
        <translation>Güç katı</translation>
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
        <translation>kinebus-card sona erdi</translation>
    </message>
    <message>
        <source>the program kinebus-card was not found: install the package kinebus-cli</source>
        <translation>kinebus-card programı bulunamadı: kinebus-cli paketini kurun</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::BenchWindow</name>
    <message>
        <source>not ready</source>
        <translation>hazır değil</translation>
    </message>
    <message>
        <source>switched off</source>
        <translation>kapalı</translation>
    </message>
    <message>
        <source>ready to switch on</source>
        <translation>açılmaya hazır</translation>
    </message>
    <message>
        <source>switched on, without current</source>
        <translation>açık, akımsız</translation>
    </message>
    <message>
        <source>holds</source>
        <translation>tutuyor</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>durdu</translation>
    </message>
    <message>
        <source>stops with a fault</source>
        <translation>arızayla duruyor</translation>
    </message>
    <message>
        <source>fault</source>
        <translation>arıza</translation>
    </message>
    <message>
        <source>Refused: %1</source>
        <translation>Reddedildi: %1</translation>
    </message>
    <message>
        <source>The card is silent: %1. It is asked again by itself.</source>
        <translation>Kart yanıt vermiyor: %1. Kendiliğinden yeniden sorulur.</translation>
    </message>
    <message>
        <source>Closed. A motor that has power holds on.</source>
        <translation>Kapatıldı. Güç alan motor tutmaya devam eder.</translation>
    </message>
    <message>
        <source>A driver card on a bench</source>
        <translation>Tezgâhta bir sürücü kartı</translation>
    </message>
    <message>
        <source>CAN interface</source>
        <translation>CAN arayüzü</translation>
    </message>
    <message>
        <source>Node id</source>
        <translation>Düğüm kimliği</translation>
    </message>
    <message>
        <source>Stop the motor</source>
        <translation>Motoru durdur</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>Sakla</translation>
    </message>
    <message>
        <source>Currents and what was measured are kept through power-off; no motor has power then</source>
        <translation>Akımlar ve ölçülenler güç kesilince de saklanır; bunun için hiçbir motorda güç olmamalı</translation>
    </message>
    <message>
        <source>Motor %1</source>
        <translation>Motor %1</translation>
    </message>
    <message>
        <source>Run current</source>
        <translation>Çalışma akımı</translation>
    </message>
    <message>
        <source>Hold current</source>
        <translation>Tutma akımı</translation>
    </message>
    <message>
        <source>Turns</source>
        <translation>Tur</translation>
    </message>
    <message>
        <source>Turns a second</source>
        <translation>Saniyede tur</translation>
    </message>
    <message>
        <source>Of a motor with 200 steps a turn</source>
        <translation>Turda 200 adımlı bir motor için</translation>
    </message>
    <message>
        <source>Set currents</source>
        <translation>Akımları ayarla</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Geri</translation>
    </message>
    <message>
        <source>On</source>
        <translation>İleri</translation>
    </message>
    <message>
        <source>Turn motor %1 back</source>
        <translation>Motor %1&apos;i geri döndür</translation>
    </message>
    <message>
        <source>Turn motor %1 on</source>
        <translation>Motor %1&apos;i ileri döndür</translation>
    </message>
    <message>
        <source>Measure the motor</source>
        <translation>Motoru ölç</translation>
    </message>
    <message>
        <source>The node measures resistance, inductance and the encoder&apos;s offset while the motor stands</source>
        <translation>Motor dururken düğüm direnci, endüktansı ve kodlayıcı kaymasını ölçer</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Kapat</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Aç</translation>
    </message>
    <message>
        <source>Let go</source>
        <translation>Bırak</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>Tut</translation>
    </message>
    <message>
        <source>Without gateway and machine file: this computer&apos;s CAN interface, and the node&apos;s id.</source>
        <translation>Ağ geçidi ve makine dosyası olmadan: bu bilgisayarın CAN arayüzü ve düğümün kimliği.</translation>
    </message>
    <message>
        <source>%1, serial number %2</source>
        <translation>%1, seri numarası %2</translation>
    </message>
    <message>
        <source>Switches: %1</source>
        <translation>Anahtarlar: %1</translation>
    </message>
    <message>
        <source>Errors that it has told: %1</source>
        <translation>Bildirdiği hatalar: %1</translation>
    </message>
    <message>
        <source>%1, error %2</source>
        <translation>%1, hata %2</translation>
    </message>
    <message>
        <source>%1 counts, %2 turns</source>
        <translation>%1 sayım, %2 tur</translation>
    </message>
    <message>
        <source>%1 measured, stage at %2, supply %3</source>
        <translation>%1 ölçüldü, güç katı %2, besleme %3</translation>
    </message>
    <message>
        <source>Measured: %1, no encoder</source>
        <translation>Ölçüldü: %1, kodlayıcı yok</translation>
    </message>
    <message>
        <source>Measured: %1, encoder offset %2</source>
        <translation>Ölçüldü: %1, kodlayıcı kayması %2</translation>
    </message>
    <message>
        <source>The card keeps its settings through power-off.</source>
        <translation>Kart ayarlarını güç kesilince de saklar.</translation>
    </message>
    <message>
        <source>Stopped by its ramp; the motor holds.</source>
        <translation>Rampasıyla durdu; motor tutuyor.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ConnectPage</name>
    <message>
        <source>Connect to a machine</source>
        <translation>Bir makineye bağlanın</translation>
    </message>
    <message>
        <source>A gateway appears here as soon as its USB cable is plugged in or its daemon runs on this computer.</source>
        <translation>Bir ağ geçidi, USB kablosu takılır takılmaz ya da arka plan programı bu bilgisayarda çalışır çalışmaz burada görünür.</translation>
    </message>
    <message>
        <source>Gateways</source>
        <translation>Ağ geçitleri</translation>
    </message>
    <message>
        <source>None found yet.</source>
        <translation>Henüz bulunamadı.</translation>
    </message>
    <message>
        <source>Demo machine</source>
        <translation>Deneme makinesi</translation>
    </message>
    <message>
        <source>The whole machine, simulated on this computer: upload, home and print without hardware.</source>
        <translation>Bütün makine bu bilgisayarda benzetimle: donanım olmadan yükleyin, referansa gönderin ve basın.</translation>
    </message>
    <message>
        <source>Try the demo</source>
        <translation>Denemeyi başlat</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>Bağlantıyı kes</translation>
    </message>
    <message>
        <source>The demo machine does not run: %1</source>
        <translation>Deneme makinesi çalışmıyor: %1</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>Bağlan</translation>
    </message>
    <message>
        <source>Connect to %1</source>
        <translation>%1 ile bağlan</translation>
    </message>
    <message>
        <source>Connecting to %1…</source>
        <translation>%1 ile bağlanılıyor…</translation>
    </message>
    <message>
        <source>%1 does not answer: %2</source>
        <translation>%1 yanıt vermiyor: %2</translation>
    </message>
    <message>
        <source>Connected to %1.</source>
        <translation>%1 ile bağlantı kuruldu.</translation>
    </message>
    <message>
        <source>The connection is lost: %1. It is tried again by itself. Jobs run on the gateway: a pulled cable does not end them.</source>
        <translation>Bağlantı koptu: %1. Kendiliğinden yeniden denenir. İşler ağ geçidinde çalışır: çekilen kablo onları bitirmez.</translation>
    </message>
    <message>
        <source>A driver card on a bench</source>
        <translation>Tezgâhta bir sürücü kartı</translation>
    </message>
    <message>
        <source>One node on this computer&apos;s CAN interface, without gateway and machine file: its motors&apos; currents, jogged and measured, and its switches.</source>
        <translation>Bu bilgisayarın CAN arayüzündeki tek düğüm, ağ geçidi ve makine dosyası olmadan: motor akımları, manuel hareket, ölçüm ve anahtarları.</translation>
    </message>
    <message>
        <source>Open the card</source>
        <translation>Kartı aç</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ConsolePage</name>
    <message>
        <source>Send</source>
        <translation>Gönder</translation>
    </message>
    <message>
        <source>Answers of the gateway</source>
        <translation>Ağ geçidinin yanıtları</translation>
    </message>
    <message>
        <source>Lines you send and the gateway&apos;s answers appear here.</source>
        <translation>Gönderdiğiniz satırlar ve ağ geçidinin yanıtları burada görünür.</translation>
    </message>
    <message>
        <source>G-code or M-code, for example M114</source>
        <translation>G kodu ya da M kodu, örneğin M114</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::DemoGateway</name>
    <message>
        <source>the demo machine has ended</source>
        <translation>deneme makinesi sonlandı</translation>
    </message>
    <message>
        <source>the program kinebusd was not found: install the package kinebus-daemon</source>
        <translation>kinebusd programı bulunamadı: kinebus-daemon paketini kurun</translation>
    </message>
    <message>
        <source>the demo machine does not answer</source>
        <translation>deneme makinesi yanıt vermiyor</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::EventsModel</name>
    <message>
        <source>Done</source>
        <translation>Bitti</translation>
    </message>
    <message>
        <source>The check of the job found a problem</source>
        <translation>İşin kontrolü bir sorun buldu</translation>
    </message>
    <message>
        <source>Message</source>
        <translation>İleti</translation>
    </message>
    <message>
        <source>node %1</source>
        <translation>düğüm %1</translation>
    </message>
    <message>
        <source>line %1</source>
        <translation>satır %1</translation>
    </message>
    <message>
        <source>Control of the machine</source>
        <translation>Makinenin kontrolü</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::FilamentKeys</name>
    <message>
        <source>Unload</source>
        <translation>Boşalt</translation>
    </message>
    <message>
        <source>Load</source>
        <translation>Yükle</translation>
    </message>
    <message>
        <source>Purge</source>
        <translation>Akıt</translation>
    </message>
    <message>
        <source>%1 mm of filament</source>
        <translation>%1 mm filament</translation>
    </message>
    <message>
        <source>[pause] of the machine file says no length</source>
        <translation>makine dosyasının [pause] tablosunda uzunluk yok</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::Gamepad</name>
    <message>
        <source>gamepad</source>
        <translation>oyun kolu</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::GatewayFinder</name>
    <message>
        <source>USB %1 · serial number %2</source>
        <translation>USB %1 · seri numarası %2</translation>
    </message>
    <message>
        <source>Gateway on this computer</source>
        <translation>Bu bilgisayardaki ağ geçidi</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatPanel</name>
    <message>
        <source>Measure a heater</source>
        <translation>Isıtıcıyı ölç</translation>
    </message>
    <message>
        <source>Its node heats it with full power for half of the way, switches it off and follows its curve. What it finds makes the heater reach its target fast, without going beyond it.</source>
        <translation>Düğümü, yolun yarısına kadar tam güçle ısıtır, kapatır ve eğrisini izler. Bulduğu değerlerle ısıtıcı hedefine çabuk ve aşmadan ulaşır.</translation>
    </message>
    <message>
        <source>Heater</source>
        <translation>Isıtıcı</translation>
    </message>
    <message>
        <source>Good at</source>
        <translation>Çalışacağı sıcaklık</translation>
    </message>
    <message>
        <source>Temperature that it shall be good at</source>
        <translation>İyi çalışacağı sıcaklık</translation>
    </message>
    <message>
        <source>It is at</source>
        <translation>Şu anki sıcaklık</translation>
    </message>
    <message>
        <source>Measure</source>
        <translation>Ölç</translation>
    </message>
    <message>
        <source>End</source>
        <translation>Bitir</translation>
    </message>
    <message>
        <source>Ends the measurement: the heater is switched off and stays as it was</source>
        <translation>Ölçümü bitirir: ısıtıcı kapatılır ve eskisi gibi kalır</translation>
    </message>
    <message>
        <source>Temperature while it is measured</source>
        <translation>Ölçüm sırasındaki sıcaklık</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>İlerleme</translation>
    </message>
    <message>
        <source>Power, by the machine file</source>
        <translation>Güç (makine dosyasından)</translation>
    </message>
    <message>
        <source>%1 W</source>
        <translation>%1 W</translation>
    </message>
    <message>
        <source>Heat capacity</source>
        <translation>Isı kapasitesi</translation>
    </message>
    <message>
        <source>%1 J/K</source>
        <translation>%1 J/K</translation>
    </message>
    <message>
        <source>Loss</source>
        <translation>Kayıp</translation>
    </message>
    <message>
        <source>%1 W/K</source>
        <translation>%1 W/K</translation>
    </message>
    <message>
        <source>Dead time</source>
        <translation>Ölü zaman</translation>
    </message>
    <message>
        <source>%1 s</source>
        <translation>%1 s</translation>
    </message>
    <message>
        <source>Lag</source>
        <translation>Gecikme</translation>
    </message>
    <message>
        <source>What was found</source>
        <translation>Bulunan değerler</translation>
    </message>
    <message>
        <source>The measurement begins</source>
        <translation>Ölçüm başlıyor</translation>
    </message>
    <message>
        <source>It heats with full power</source>
        <translation>Tam güçle ısıtılıyor</translation>
    </message>
    <message>
        <source>The power is off, its curve is followed</source>
        <translation>Güç kapalı, eğrisi izleniyor</translation>
    </message>
    <message>
        <source>The node works out what it has seen, and stores it</source>
        <translation>Düğüm gördüklerini hesaplıyor ve saklıyor</translation>
    </message>
    <message>
        <source>Measured, to be good at %1</source>
        <translation>%1 için ölçüldü</translation>
    </message>
    <message>
        <source>The heater&apos;s node works by these values from now on, and keeps them without power.</source>
        <translation>Isıtıcının düğümü bundan sonra bu değerlerle çalışır ve onları elektrik kesilse de saklar.</translation>
    </message>
    <message>
        <source>The heater&apos;s node works by these values from now on. %1</source>
        <translation>Isıtıcının düğümü bundan sonra bu değerlerle çalışır. %1</translation>
    </message>
    <message>
        <source>Not measured</source>
        <translation>Ölçülmedi</translation>
    </message>
    <message>
        <source>Not measured since the gateway was started</source>
        <translation>Ağ geçidi başlatıldığından beri ölçülmedi</translation>
    </message>
    <message>
        <source>This machine has no heater</source>
        <translation>Bu makinede ısıtıcı yok</translation>
    </message>
    <message>
        <source>%1 gets full power until it is half of the way to %2. It is hot then, and the machine does nothing else for some minutes. Its fan should blow as it does in a print.</source>
        <translation>%1, %2 yolunun yarısına kadar tam güç alır. Isınır ve makine birkaç dakika başka bir şey yapmaz. Fanı, baskıdaki gibi çalışmalıdır.</translation>
    </message>
    <message>
        <source>Not now</source>
        <translation>Şimdi değil</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatPlot</name>
    <message>
        <source>Temperatures</source>
        <translation>Sıcaklıklar</translation>
    </message>
    <message>
        <source>Time that is shown</source>
        <translation>Gösterilen süre</translation>
    </message>
    <message>
        <source>10 minutes</source>
        <translation>10 dakika</translation>
    </message>
    <message>
        <source>Whole job</source>
        <translation>Tüm iş</translation>
    </message>
    <message>
        <source>Temperatures, power and fans</source>
        <translation>Sıcaklıklar, güç ve fanlar</translation>
    </message>
    <message>
        <source>begin</source>
        <translation>başlangıç</translation>
    </message>
    <message>
        <source>10 minutes ago</source>
        <translation>10 dakika önce</translation>
    </message>
    <message>
        <source>now</source>
        <translation>şimdi</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::HeatersCard</name>
    <message>
        <source>Heat</source>
        <translation>Sıcaklık</translation>
    </message>
    <message>
        <source>Heat for a material</source>
        <translation>Malzemeye göre ısıt</translation>
    </message>
    <message>
        <source>Temperatures by the machine file: tables [material.NAME]</source>
        <translation>Sıcaklıklar makine dosyasından: [material.NAME] tabloları</translation>
    </message>
    <message>
        <source>Bed</source>
        <translation>Tabla</translation>
    </message>
    <message>
        <source>Chamber</source>
        <translation>Kabin</translation>
    </message>
    <message>
        <source>Nozzle %1</source>
        <translation>Nozul %1</translation>
    </message>
    <message>
        <source>Nozzle</source>
        <translation>Nozul</translation>
    </message>
    <message>
        <source>Target temperature of the bed</source>
        <translation>Tablanın hedef sıcaklığı</translation>
    </message>
    <message>
        <source>Target temperature of the chamber</source>
        <translation>Kabinin hedef sıcaklığı</translation>
    </message>
    <message>
        <source>Target temperature of nozzle %1</source>
        <translation>%1 nozulunun hedef sıcaklığı</translation>
    </message>
    <message>
        <source>Target temperature of the nozzle</source>
        <translation>Nozulun hedef sıcaklığı</translation>
    </message>
    <message>
        <source>off</source>
        <translation>kapalı</translation>
    </message>
    <message>
        <source>%1, in use</source>
        <translation>%1, kullanımda</translation>
    </message>
    <message>
        <source>Fan %1</source>
        <translation>Fan %1</translation>
    </message>
    <message>
        <source>Fan</source>
        <translation>Fan</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobPanel</name>
    <message>
        <source>Interrupted: clear the stop, then resume goes on from its place.</source>
        <translation>Yarıda kaldı: durdurmayı kaldırın, sonra Sürdür kaldığı yerden devam eder.</translation>
    </message>
    <message>
        <source>Interrupted: clear the alarm, then resume goes on from its place.</source>
        <translation>Yarıda kaldı: alarmı kaldırın, sonra Sürdür kaldığı yerden devam eder.</translation>
    </message>
    <message>
        <source>Interrupted: resume goes on from its place.</source>
        <translation>Yarıda kaldı: Sürdür, kaldığı yerden devam eder.</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>İlerleme</translation>
    </message>
    <message>
        <source>Elapsed</source>
        <translation>Geçen süre</translation>
    </message>
    <message>
        <source>Remaining</source>
        <translation>Kalan süre</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>Satır</translation>
    </message>
    <message>
        <source>Cancel the job</source>
        <translation>İşi iptal et</translation>
    </message>
    <message>
        <source>Cancel the job? What is printed stays on the bed.</source>
        <translation>İş iptal edilsin mi? Basılan kısım tablada kalır.</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>Sürdür</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Hız</translation>
    </message>
    <message>
        <source>Feed override in percent</source>
        <translation>Yüzde olarak ilerleme çarpanı</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Duraklat</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>Sürdür</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>İptal</translation>
    </message>
    <message>
        <source>No job is running</source>
        <translation>Çalışan iş yok</translation>
    </message>
    <message>
        <source>Last known. What the job does now is unknown.</source>
        <translation>Son bilinen durum: işin şu anda ne yaptığı bilinmiyor.</translation>
    </message>
    <message>
        <source>Leave an object out</source>
        <translation>Bir nesneyi atla</translation>
    </message>
    <message>
        <source>Print no more of %1? It cannot be taken back.</source>
        <translation>%1 artık basılmasın mı? Bu geri alınamaz.</translation>
    </message>
    <message>
        <source>Set aside</source>
        <translation>Kenara al</translation>
    </message>
    <message>
        <source>The tool rises and parks: then jog, heat, extrude or change the filament. Resume goes on from the job&apos;s place.</source>
        <translation>Takım yükselir ve park eder: ardından manuel hareket, ısıtma, ekstrüzyon ya da filament değişimi yapılabilir. Sürdürünce iş kaldığı yerden devam eder.</translation>
    </message>
    <message>
        <source>Finished.</source>
        <translation>Bitti.</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>İptal edildi.</translation>
    </message>
    <message>
        <source>Not begun: the Jobs page says what is wrong.</source>
        <translation>Başlamadı: sorunu İşler sayfası söyler.</translation>
    </message>
    <message>
        <source>Ended by a stop.</source>
        <translation>Bir durdurmayla sona erdi.</translation>
    </message>
    <message>
        <source>Change the filament: load, purge, then resume.</source>
        <translation>Filamenti değiştirin: yükleyin, akıtın, sonra sürdürün.</translation>
    </message>
    <message>
        <source>Filament</source>
        <translation>Filament</translation>
    </message>
    <message>
        <source>%1 m</source>
        <translation>%1 m</translation>
    </message>
    <message>
        <source>Clock error</source>
        <translation>Saat hatası</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
    <message>
        <source>Bus load</source>
        <translation>Veri yolu</translation>
    </message>
    <message>
        <source>Least queue</source>
        <translation>En az kuyruk</translation>
    </message>
    <message>
        <source>Slowed</source>
        <translation>Yavaşlama</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobUpload</name>
    <message>
        <source>%1 cannot be read</source>
        <translation>%1 okunamıyor</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobsModel</name>
    <message>
        <source>Job</source>
        <translation>İş</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>Boyut</translation>
    </message>
    <message>
        <source>Uploaded</source>
        <translation>Yüklendi</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>Kontrol</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Süre</translation>
    </message>
    <message>
        <source>Last run</source>
        <translation>Son çalışma</translation>
    </message>
    <message>
        <source>Reading</source>
        <translation>Okunuyor</translation>
    </message>
    <message>
        <source>Waiting for the gateway</source>
        <translation>Ağ geçidi bekleniyor</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Başarısız</translation>
    </message>
    <message>
        <source>Not checked</source>
        <translation>Kontrol edilmedi</translation>
    </message>
    <message numerus="yes">
        <source>%Ln error(s)</source>
        <translation>
            <numerusform>%Ln hata</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%Ln warning(s)</source>
        <translation>
            <numerusform>%Ln uyarı</numerusform>
        </translation>
    </message>
    <message>
        <source>Fine</source>
        <translation>Sorunsuz</translation>
    </message>
    <message>
        <source>Never</source>
        <translation>Hiç</translation>
    </message>
    <message>
        <source>Running</source>
        <translation>Çalışıyor</translation>
    </message>
    <message>
        <source>Complete, %1</source>
        <translation>Tamamlandı, %1</translation>
    </message>
    <message>
        <source>Cancelled</source>
        <translation>İptal edildi</translation>
    </message>
    <message>
        <source>Refused by the check</source>
        <translation>Kontrolde reddedildi</translation>
    </message>
    <message>
        <source>Stopped by an alarm</source>
        <translation>Alarmla durdu</translation>
    </message>
    <message>
        <source>Interrupted</source>
        <translation>Kesildi</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobsPage</name>
    <message>
        <source>Drop G-code files here to send them to the gateway</source>
        <translation>Ağ geçidine göndermek için G kodu dosyalarını buraya bırakın</translation>
    </message>
    <message>
        <source>Choose a file…</source>
        <translation>Dosya seç…</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Başlat</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>Kontrol et</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>Göster</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Sil</translation>
    </message>
    <message>
        <source>Jobs on the gateway</source>
        <translation>Ağ geçidindeki işler</translation>
    </message>
    <message>
        <source>What the check has found</source>
        <translation>Kontrolün buldukları</translation>
    </message>
    <message>
        <source>Lines of the job</source>
        <translation>İşin satırları</translation>
    </message>
    <message>
        <source>Choose a finding: its line is shown here, its place in the scene.</source>
        <translation>Bir bulgu seçin: satırı burada, yeri sahnede gösterilir.</translation>
    </message>
    <message>
        <source>Checking %1…</source>
        <translation>%1 kontrol ediliyor…</translation>
    </message>
    <message numerus="yes">
        <source>%1: %Ln error(s). It will not start.</source>
        <translation>
            <numerusform>%1: %Ln hata. Başlamayacak.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%1: it can be printed, with %Ln warning(s). It takes %2.</source>
        <translation>
            <numerusform>%1: %Ln uyarıyla basılabilir. Süresi %2.</numerusform>
        </translation>
    </message>
    <message>
        <source>%1: nothing is wrong. It takes %2.</source>
        <translation>%1: hiçbir sorun yok. Süresi %2.</translation>
    </message>
    <message>
        <source>The gateway checks a whole job against every limit before anything moves.</source>
        <translation>Ağ geçidi, bir şey kımıldamadan önce işin tümünü her sınıra karşı kontrol eder.</translation>
    </message>
    <message>
        <source>%1 of %2 used</source>
        <translation>%2 içinden %1 dolu</translation>
    </message>
    <message>
        <source>Send G-code to the gateway</source>
        <translation>Ağ geçidine G kodu gönder</translation>
    </message>
    <message>
        <source>G-code (*.gcode *.ngc *.nc *.g *.gco)</source>
        <translation>G kodu (*.gcode *.ngc *.nc *.g *.gco)</translation>
    </message>
    <message>
        <source>All files (*)</source>
        <translation>Tüm dosyalar (*)</translation>
    </message>
    <message>
        <source>Delete %1 from the gateway?</source>
        <translation>%1 ağ geçidinden silinsin mi?</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>Vazgeç</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JogPad</name>
    <message>
        <source>Jog</source>
        <translation>Manuel hareket</translation>
    </message>
    <message>
        <source>A click is a step; a button or key that is held moves until it is let go. Keys: arrows move X and Y, Page Up and Page Down move Z, A and D tilt, Q and W turn the table, 1 to 5 choose the step.</source>
        <translation>Bir tıklama bir adımdır; basılı tutulan düğme ya da tuş bırakılana kadar hareket ettirir. Tuşlar: oklar X ve Y&apos;yi, Page Up ve Page Down Z&apos;yi sürer; A ve D eğer, Q ve W tablayı döndürür, 1–5 adımı seçer.</translation>
    </message>
    <message>
        <source>Step, mm or °</source>
        <translation>Adım, mm ya da °</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Hız</translation>
    </message>
    <message>
        <source>mm/s</source>
        <translation>mm/sn</translation>
    </message>
    <message>
        <source>Move by %1</source>
        <translation>%1 ile hareket ettir</translation>
    </message>
    <message>
        <source>It moves while it is deflected and its left shoulder key is held: left stick X and Y, right stick Z and C; a little is slow.</source>
        <translation>Kol itilirken ve sol omuz tuşu basılıyken hareket eder: sol çubuk X ve Y, sağ çubuk Z ve C; az itilince yavaştır.</translation>
    </message>
    <message>
        <source>It moves while it is deflected, along one axis at a time; a little is slow.</source>
        <translation>İtilirken hareket eder, her seferinde bir eksen boyunca; az itilince yavaştır.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JogPage</name>
    <message>
        <source>Jog</source>
        <translation>Manuel hareket</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>Makine</translation>
    </message>
    <message>
        <source>Home</source>
        <translation>Referansa git</translation>
    </message>
    <message>
        <source>Wakes the nodes and brings all carriages to their switches</source>
        <translation>Düğümleri uyandırır ve bütün taşıyıcıları anahtarlarına götürür</translation>
    </message>
    <message>
        <source>Bed reference</source>
        <translation>Tabla referansı</translation>
    </message>
    <message>
        <source>Goes to where every job begins</source>
        <translation>Her işin başladığı yere gider</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Duraklat</translation>
    </message>
    <message>
        <source>Clear stop</source>
        <translation>Durdurmayı kaldır</translation>
    </message>
    <message>
        <source>Motors off</source>
        <translation>Motorları kapat</translation>
    </message>
    <message>
        <source>Positions are lost: the machine must be homed again</source>
        <translation>Konumlar yitirilir: makine yeniden referansa gönderilmelidir</translation>
    </message>
    <message>
        <source>Work offsets</source>
        <translation>İş ofsetleri</translation>
    </message>
    <message>
        <source>Coordinate system</source>
        <translation>Koordinat sistemi</translation>
    </message>
    <message>
        <source>Zero here</source>
        <translation>Burayı sıfırla</translation>
    </message>
    <message>
        <source>The tool&apos;s position becomes the zero of this system</source>
        <translation>Takımın konumu bu sistemin sıfırı olur</translation>
    </message>
    <message>
        <source>Set</source>
        <translation>Ayarla</translation>
    </message>
    <message>
        <source>The values above become the zero of this system</source>
        <translation>Yukarıdaki değerler bu sistemin sıfırı olur</translation>
    </message>
    <message>
        <source>Active: %1, zero at %2</source>
        <translation>Etkin: %1, sıfırı %2</translation>
    </message>
    <message>
        <source>Zeros of the work coordinates</source>
        <translation>İş koordinatlarının sıfırları</translation>
    </message>
    <message>
        <source>Pin out</source>
        <translation>Pimi çıkar</translation>
    </message>
    <message>
        <source>Pin in</source>
        <translation>Pimi içeri çek</translation>
    </message>
    <message>
        <source>Self test</source>
        <translation>Kendini sınama</translation>
    </message>
    <message>
        <source>The pin goes out and in by itself, until it is told something else</source>
        <translation>Pim, başka bir şey istenene kadar kendiliğinden çıkar ve girer</translation>
    </message>
    <message>
        <source>End alarm</source>
        <translation>Alarmı bitir</translation>
    </message>
    <message>
        <source>The probe forgets its alarm, and the pin goes in</source>
        <translation>Prob alarmını unutur ve pim içeri girer</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is out</source>
        <translation>Probun pimi dışarıda</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is in</source>
        <translation>Probun pimi içeride</translation>
    </message>
    <message>
        <source>The probe&apos;s pin moves</source>
        <translation>Probun pimi hareket ediyor</translation>
    </message>
    <message>
        <source>The probe tests itself</source>
        <translation>Prob kendini sınıyor</translation>
    </message>
    <message>
        <source>The probe&apos;s pin is not where it should be</source>
        <translation>Probun pimi olması gereken yerde değil</translation>
    </message>
    <message>
        <source>Filament</source>
        <translation>Filament</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MachineFileEditor</name>
    <message>
        <source>Read again</source>
        <translation>Yeniden oku</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Geri al</translation>
    </message>
    <message>
        <source>Save on the gateway</source>
        <translation>Ağ geçidine kaydet</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>Makine dosyası</translation>
    </message>
    <message>
        <source>What is wrong in the machine file</source>
        <translation>Makine dosyasındaki yanlışlar</translation>
    </message>
    <message>
        <source>Saved. The gateway uses it from its next start.</source>
        <translation>Kaydedildi. Ağ geçidi bir sonraki açılıştan sonra kullanır.</translation>
    </message>
    <message>
        <source>The built-in machine file</source>
        <translation>Yerleşik makine dosyası</translation>
    </message>
    <message>
        <source>Not read yet</source>
        <translation>Henüz okunmadı</translation>
    </message>
    <message>
        <source>cannot be changed from here</source>
        <translation>buradan değiştirilemez</translation>
    </message>
    <message>
        <source>newer than what the gateway runs with</source>
        <translation>ağ geçidinin kullandığından yeni</translation>
    </message>
    <message>
        <source>The machine file says what the machine is: kinematics, axes, limits, nodes.</source>
        <translation>Makine dosyası makinenin ne olduğunu söyler: kinematik, eksenler, sınırlar, düğümler.</translation>
    </message>
    <message>
        <source>Checking…</source>
        <translation>Kontrol ediliyor…</translation>
    </message>
    <message>
        <source>The file is right.</source>
        <translation>Dosya doğru.</translation>
    </message>
    <message numerus="yes">
        <source>%Ln mistake(s): it cannot be saved.</source>
        <translation>
            <numerusform>%Ln yanlış: kaydedilemez.</numerusform>
        </translation>
    </message>
    <message>
        <source>Restart the gateway</source>
        <translation>Ağ geçidini yeniden başlat</translation>
    </message>
    <message>
        <source>It begins anew with the file as it is saved, and keeps positions</source>
        <translation>Kaydedilen dosyayla yeniden başlar ve konumları korur</translation>
    </message>
    <message>
        <source>What you have changed here is not saved. Read the gateway&apos;s file over it?</source>
        <translation>Burada yaptığınız değişiklikler kaydedilmedi. Ağ geçidinin dosyası üzerlerine okunsun mu?</translation>
    </message>
    <message>
        <source>Keep my changes</source>
        <translation>Değişikliklerim kalsın</translation>
    </message>
    <message>
        <source>The gateway begins anew.</source>
        <translation>Ağ geçidi yeniden başlıyor.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MachinePage</name>
    <message>
        <source>Machine</source>
        <translation>Makine</translation>
    </message>
    <message>
        <source>Axes and nodes</source>
        <translation>Eksenler ve düğümler</translation>
    </message>
    <message>
        <source>Bus and time</source>
        <translation>Veri yolu ve zaman</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>Makine dosyası</translation>
    </message>
    <message>
        <source>Axes</source>
        <translation>Eksenler</translation>
    </message>
    <message>
        <source>Nodes</source>
        <translation>Düğümler</translation>
    </message>
    <message>
        <source>Bus load</source>
        <translation>Veri yolu yükü</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
    <message>
        <source>Largest clock error</source>
        <translation>En büyük saat hatası</translation>
    </message>
    <message>
        <source>Emptiest queue</source>
        <translation>En boş kuyruk</translation>
    </message>
    <message>
        <source>Path rate</source>
        <translation>Yol hızı oranı</translation>
    </message>
    <message>
        <source>Frames sent</source>
        <translation>Gönderilen çerçeve</translation>
    </message>
    <message>
        <source>Frames received</source>
        <translation>Alınan çerçeve</translation>
    </message>
    <message>
        <source>Segments sent</source>
        <translation>Gönderilen parça</translation>
    </message>
    <message>
        <source>Sequence errors</source>
        <translation>Sıra hatası</translation>
    </message>
    <message>
        <source>Underruns</source>
        <translation>Kuyruk boşalması</translation>
    </message>
    <message>
        <source>Unreadable frames</source>
        <translation>Okunamayan çerçeve</translation>
    </message>
    <message>
        <source>Frames of strangers</source>
        <translation>Yabancı çerçeve</translation>
    </message>
    <message>
        <source>Slowed for the bus</source>
        <translation>Veri yolu yavaşlatma</translation>
    </message>
    <message>
        <source>Held for planning</source>
        <translation>Planlama beklemesi</translation>
    </message>
    <message>
        <source>Not connected.</source>
        <translation>Bağlı değil.</translation>
    </message>
    <message>
        <source>%1 · kinematics %2 · %3 axes on %4 nodes · bus %5</source>
        <translation>%1 · kinematik %2 · %4 düğümde %3 eksen · veri yolu %5</translation>
    </message>
    <message>
        <source>Motors</source>
        <translation>Motorlar</translation>
    </message>
    <message>
        <source>Heaters</source>
        <translation>Isıtıcılar</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MainWindow</name>
    <message>
        <source>Gateways</source>
        <translation>Ağ geçitleri</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Görünüm</translation>
    </message>
    <message>
        <source>Jobs</source>
        <translation>İşler</translation>
    </message>
    <message>
        <source>Jog</source>
        <translation>Manuel</translation>
    </message>
    <message>
        <source>Console</source>
        <translation>Konsol</translation>
    </message>
    <message>
        <source>Alarms</source>
        <translation>Alarmlar</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>Makine</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>Konum</translation>
    </message>
    <message>
        <source>Job</source>
        <translation>İş</translation>
    </message>
    <message>
        <source>Close the demo</source>
        <translation>Tanıtımı kapat</translation>
    </message>
    <message>
        <source>The demo machine ends with this window, and its job with it.</source>
        <translation>Tanıtım makinesi bu pencereyle, işi de onunla biter.</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Kapat</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>Sürdür</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MotorsPanel</name>
    <message>
        <source>Motors</source>
        <translation>Motorlar</translation>
    </message>
    <message>
        <source>Motor</source>
        <translation>Motor</translation>
    </message>
    <message>
        <source>Run current</source>
        <translation>Çalışma akımı</translation>
    </message>
    <message>
        <source>Hold current</source>
        <translation>Tutma akımı</translation>
    </message>
    <message>
        <source>Set currents</source>
        <translation>Akımları ayarla</translation>
    </message>
    <message>
        <source>Counts when the machine next stands still, and until the gateway is started anew</source>
        <translation>Makine bir sonraki duruşunda geçerli olur, ağ geçidi yeniden başlatılana kadar sürer</translation>
    </message>
    <message>
        <source>Jog this motor alone</source>
        <translation>Yalnız bu motorun manuel hareketi</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>Adım</translation>
    </message>
    <message>
        <source>Jog back</source>
        <translation>Manuel: geri</translation>
    </message>
    <message>
        <source>Jog on</source>
        <translation>Manuel: ileri</translation>
    </message>
    <message>
        <source>Measure the motor</source>
        <translation>Motoru ölç</translation>
    </message>
    <message>
        <source>The node measures resistance, inductance and the encoder&apos;s offset while the motor stands</source>
        <translation>Motor dururken düğüm direnci, endüktansı ve kodlayıcı kaymasını ölçer</translation>
    </message>
    <message>
        <source>Switches of node %1: %2</source>
        <translation>Düğüm %1 anahtarları: %2</translation>
    </message>
    <message>
        <source>One node on a bench, without a machine file: stop the gateway, then the page Gateways, or %1 on the computer with the bus, shows, sets, jogs and measures its motors.</source>
        <translation>Tezgâhta tek düğüm, makine dosyası olmadan: ağ geçidini durdurun; Ağ geçitleri sayfası ya da veri yolunun bağlı olduğu bilgisayarda %1 motorlarını gösterir, ayarlar, manuel hareket ettirir ve ölçer.</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::NodesModel</name>
    <message>
        <source>Node</source>
        <translation>Düğüm</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Durum</translation>
    </message>
    <message>
        <source>Clock error</source>
        <translation>Saat hatası</translation>
    </message>
    <message>
        <source>Queue</source>
        <translation>Kuyruk</translation>
    </message>
    <message>
        <source>Inputs</source>
        <translation>Girişler</translation>
    </message>
    <message>
        <source>Segments sent</source>
        <translation>Gönderilen parça</translation>
    </message>
    <message>
        <source>Faults</source>
        <translation>Arızalar</translation>
    </message>
    <message>
        <source>Not there</source>
        <translation>Yok</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Durdu</translation>
    </message>
    <message>
        <source>Starting</source>
        <translation>Başlıyor</translation>
    </message>
    <message>
        <source>Idle</source>
        <translation>Boşta</translation>
    </message>
    <message>
        <source>Operational</source>
        <translation>Çalışır durumda</translation>
    </message>
    <message>
        <source>Operational, not in time</source>
        <translation>Çalışır, eşzamanlı değil</translation>
    </message>
    <message>
        <source>Waiting</source>
        <translation>Bekliyor</translation>
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
        <translation>Kapat</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::NumberField</name>
    <message>
        <source>%1 is not within %2 to %3</source>
        <translation>%1, %2 ile %3 arasında değil</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::PlotWidget</name>
    <message>
        <source>%1 s ago</source>
        <translation>%1 sn önce</translation>
    </message>
    <message>
        <source>now</source>
        <translation>şimdi</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::PositionPanel</name>
    <message>
        <source>Carriages and axes</source>
        <translation>Taşıyıcılar ve eksenler</translation>
    </message>
    <message>
        <source>By its scale %1 (%2)</source>
        <translation>Cetveline göre %1 (%2)</translation>
    </message>
    <message>
        <source>By its scale: read at rest</source>
        <translation>Cetveli dururken okunur</translation>
    </message>
    <message>
        <source>Tool over the part</source>
        <translation>Parçaya göre takım</translation>
    </message>
    <message>
        <source>Position not known yet</source>
        <translation>Konum henüz bilinmiyor</translation>
    </message>
    <message>
        <source>Last known position</source>
        <translation>Son bilinen konum</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ProblemsModel</name>
    <message>
        <source>Error</source>
        <translation>Hata</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>Uyarı</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>Tür</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>Satır</translation>
    </message>
    <message>
        <source>What is wrong</source>
        <translation>Sorun</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::SocketLink</name>
    <message>
        <source>the gateway closed the connection</source>
        <translation>ağ geçidi bağlantıyı kapattı</translation>
    </message>
    <message>
        <source>on this computer</source>
        <translation>bu bilgisayarda</translation>
    </message>
    <message>
        <source>no gateway runs there</source>
        <translation>orada çalışan ağ geçidi yok</translation>
    </message>
    <message>
        <source>this user may not use the gateway&apos;s socket</source>
        <translation>bu kullanıcı ağ geçidinin soketini kullanamaz</translation>
    </message>
    <message>
        <source>the connection on this computer has failed</source>
        <translation>bu bilgisayardaki bağlantı kurulamadı</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::SpaceMouse</name>
    <message>
        <source>3D mouse</source>
        <translation>3B fare</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::TopBar</name>
    <message>
        <source>STOP</source>
        <translation>DUR</translation>
    </message>
    <message>
        <source>Stops all motion at once, on the path (Ctrl+.)</source>
        <translation>Bütün hareketi hemen, yol üzerinde durdurur (Ctrl+.)</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>Dil</translation>
    </message>
    <message>
        <source>Light or dark</source>
        <translation>Açık ya da koyu</translation>
    </message>
    <message>
        <source>Take control</source>
        <translation>Kontrolü al</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>Kontrol %1 programında</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>Bağlı değil</translation>
    </message>
    <message>
        <source>Connecting</source>
        <translation>Bağlanıyor</translation>
    </message>
    <message>
        <source>Connection lost</source>
        <translation>Bağlantı koptu</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>Bağlan</translation>
    </message>
    <message>
        <source>%1 · %2</source>
        <translation>%1 · %2</translation>
    </message>
    <message>
        <source>Choose a gateway</source>
        <translation>Bir ağ geçidi seçin</translation>
    </message>
    <message>
        <source>No news for %1. Last known: %2</source>
        <translation>%1 süredir haber yok. Son bilinen: %2</translation>
    </message>
    <message>
        <source>No news for %1. Last known: %2, %3 at %4</source>
        <translation>%1 süredir haber yok. Son bilinen: %2, %3 %4</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::TuningPlot</name>
    <message>
        <source>The curve is drawn here while a heater is measured.</source>
        <translation>Bir ısıtıcı ölçülürken eğrisi burada çizilir.</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Hedef</translation>
    </message>
    <message>
        <source>full power</source>
        <translation>tam güç</translation>
    </message>
</context>
<context>
    <name>kinebus::gui::UsbLink</name>
    <message>
        <source>the USB cable was pulled</source>
        <translation>USB kablosu çekildi</translation>
    </message>
    <message>
        <source>the gateway is not plugged in</source>
        <translation>ağ geçidi takılı değil</translation>
    </message>
    <message>
        <source>this user may not use the USB device: install the udev rule of the package</source>
        <translation>bu kullanıcı USB aygıtını kullanamıyor: paketin udev kuralını kurun</translation>
    </message>
    <message>
        <source>another program uses the gateway&apos;s USB link</source>
        <translation>ağ geçidinin USB bağlantısını başka bir program kullanıyor</translation>
    </message>
    <message>
        <source>the USB link does not start</source>
        <translation>USB bağlantısı başlamıyor</translation>
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
        <translation>3B sahne gösterilemiyor: %1</translation>
    </message>
    <message>
        <source>Scene: machine and tool path</source>
        <translation>Sahne: makine ve takım yolu</translation>
    </message>
    <message>
        <source>Show the layers up to here</source>
        <translation>Katmanları buraya kadar göster</translation>
    </message>
    <message>
        <source>Colour by</source>
        <translation>Renk</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>İlerleme hızı</translation>
    </message>
    <message>
        <source>Layer</source>
        <translation>Katman</translation>
    </message>
    <message>
        <source>Limit margin</source>
        <translation>Sınıra uzaklık</translation>
    </message>
    <message>
        <source>Colour of the tool path</source>
        <translation>Takım yolunun rengi</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>Makine</translation>
    </message>
    <message>
        <source>Reach of the tool</source>
        <translation>Takımın erişimi</translation>
    </message>
    <message>
        <source>Moves without extrusion</source>
        <translation>Ekstrüzyonsuz hareketler</translation>
    </message>
    <message>
        <source>What is not printed yet</source>
        <translation>Henüz basılmayan</translation>
    </message>
    <message>
        <source>From a corner</source>
        <translation>Köşeden</translation>
    </message>
    <message>
        <source>From above</source>
        <translation>Üstten</translation>
    </message>
    <message>
        <source>From the front</source>
        <translation>Önden</translation>
    </message>
    <message>
        <source>Whole machine (M)</source>
        <translation>Bütün makine (M)</translation>
    </message>
    <message>
        <source>The part alone (F)</source>
        <translation>Yalnız parça (F)</translation>
    </message>
    <message>
        <source>%1 mm/s</source>
        <translation>%1 mm/sn</translation>
    </message>
    <message>
        <source>at a limit</source>
        <translation>sınırda</translation>
    </message>
    <message>
        <source>free</source>
        <translation>serbest</translation>
    </message>
    <message>
        <source>%1 cannot be shown: %2</source>
        <translation>%1 gösterilemiyor: %2</translation>
    </message>
    <message>
        <source>Reading %1</source>
        <translation>%1 okunuyor</translation>
    </message>
    <message>
        <source>%1 · %2 lines · %3 layers · %4 m of path</source>
        <translation>%1 · %2 satır · %3 katman · %4 m yol</translation>
    </message>
    <message numerus="yes">
        <source>%Ln line(s) are refused and not drawn</source>
        <translation>
            <numerusform>%Ln satır reddedildi ve çizilmedi</numerusform>
        </translation>
    </message>
    <message>
        <source>No job is shown. Choose one on the Jobs page.</source>
        <translation>Gösterilen iş yok. İşler sayfasından seçin.</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>As a body</source>
        <translation>Cisim olarak</translation>
    </message>
    <message>
        <source>Show the layers from here on</source>
        <translation>Katmanları buradan başlayarak göster</translation>
    </message>
    <message>
        <source>Show the topmost layer&apos;s moves up to here</source>
        <translation>En üst katmanın hareketlerini buraya kadar göster</translation>
    </message>
    <message>
        <source>Kind of line</source>
        <translation>Çizgi türü</translation>
    </message>
    <message>
        <source>other</source>
        <translation>diğer</translation>
    </message>
    <message>
        <source>outer wall</source>
        <translation>dış duvar</translation>
    </message>
    <message>
        <source>inner wall</source>
        <translation>iç duvar</translation>
    </message>
    <message>
        <source>infill</source>
        <translation>dolgu</translation>
    </message>
    <message>
        <source>top and bottom</source>
        <translation>üst ve alt</translation>
    </message>
    <message>
        <source>bridge</source>
        <translation>köprü</translation>
    </message>
    <message>
        <source>support</source>
        <translation>destek</translation>
    </message>
    <message>
        <source>skirt and brim</source>
        <translation>etek ve kenarlık</translation>
    </message>
    <message>
        <source>gap</source>
        <translation>boşluk</translation>
    </message>
    <message>
        <source>Where the tool went in the last five minutes</source>
        <translation>Takımın son beş dakikada gittiği yol</translation>
    </message>
    <message>
        <source>%1, by the encoders: at most %2 mm from where it should have been</source>
        <translation>%1, kodlayıcılara göre: olması gereken yerden en çok %2 mm uzakta</translation>
    </message>
    <message>
        <source>%1, as commanded: no axis has an encoder</source>
        <translation>%1, komuta göre: hiçbir eksende kodlayıcı yok</translation>
    </message>
</context>
</TS>
