// SPDX-License-Identifier: MIT
// Text logs of CAN frames: lines typed by hand as the tools write them.
#include <gtest/gtest.h>

#include "decoder/link/socketcan.hpp"
#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// "id flags data", flags: x extended, r remote, e error, f FD.
std::string show(const ReadFrame& read) {
  const can::Place place = can::find_frame(read.raw);
  char text[40];
  if (place.malformed) {
    std::snprintf(text, sizeof text, "malformed %d", static_cast<int>(place.why));
    return text;
  }
  const can::Frame& frame = place.frame;
  std::snprintf(text, sizeof text, "%X %s%s%s", frame.identifier, frame.extended ? "x" : "", frame.remote ? "r" : "",
                frame.error ? "e" : "");
  std::string all = text;
  for (const std::uint8_t byte : frame.data) {
    std::snprintf(text, sizeof text, " %02X", byte);
    all += text;
  }
  return all;
}

TEST(Candump, EveryKindOfFrame) {
  const ReadCapture capture =
      read_both(bytes_of("(1700000002.501431) can0 5FF#00341245230000 R\n"
                         "(1700000002.501432) can1 12345678#\r\n"
                         "\n"
                         "(1700000002.501433) can0 123#R\n"
                         "(1700000002.501434) can0 123#R4 T\n"
                         "(1700000002.501435) can0 20000004#000C000000000000\n"
                         "(1700000002.501436) can0 123##3001122334455667788\n"
                         "(1700000002.501437) vcan0 7FF#11.22.33\n"
                         "(1700000002.501438) can0 001#0102030405060708_C\n"));
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 8U);
  EXPECT_EQ(capture.format, "candump log");
  EXPECT_EQ(show(capture.frames[0]), "5FF  00 34 12 45 23 00 00");
  EXPECT_EQ(capture.frames[0].raw.time_ns, 1700000002 * kSecond + 501'431'000);
  EXPECT_EQ(capture.frames[0].raw.time_resolution_ns, 1000U);
  EXPECT_EQ(capture.frames[0].raw.link_type, LinkType::kCanSocketcan);
  EXPECT_EQ(show(capture.frames[1]), "12345678 x");
  EXPECT_EQ(show(capture.frames[2]), "123 r");
  EXPECT_EQ(show(capture.frames[3]), "123 r");
  EXPECT_EQ(capture.frames[3].bytes[4], 4);
  EXPECT_EQ(show(capture.frames[4]), "4 e 00 0C 00 00 00 00 00 00");
  EXPECT_EQ(show(capture.frames[5]), "malformed 7") << "CAN FD";
  EXPECT_EQ(capture.frames[5].bytes[5], 0x07);
  EXPECT_EQ(show(capture.frames[6]), "7FF  11 22 33");
  EXPECT_EQ(show(capture.frames[7]), "1  01 02 03 04 05 06 07 08");
  ASSERT_EQ(capture.interfaces.size(), 3U);
  EXPECT_EQ(capture.interfaces[1].name, "can1");
  EXPECT_EQ(capture.frames[6].raw.interface_id, 2U);
}

TEST(Candump, BrokenLinesAreErrorsWithTheirNumber) {
  const std::string good = "(1.5) can0 5FF#00\n";
  const std::pair<std::string, std::string> cases[] = {
      {"hello\n", "-:2: no line of a candump log: it begins with no (time)"},
      {"(x) can0 5FF#00\n", "-:2: no line of a candump log: its time is no number"},
      {"(1.5) can0 5FF\n", "-:2: no line of a candump log: no identifier#data behind the interface"},
      {"(1.5) can0 5FFF#00\n",
       "-:2: no line of a candump log: an identifier that has neither 3 nor 8 hexadecimal digits"},
      {"(1.5) can0 5FF#0\n", "-:2: no line of a candump log: data that are no pairs of hexadecimal digits"},
      {"(1.5) can0 5FF#000102030405060708\n", "-:2: no line of a candump log: more data than a frame can hold"},
      {"(1.5) can0 5FF#R9\n", "-:2: no line of a candump log: a remote frame of an impossible length"},
  };
  for (const auto& [line, error] : cases) {
    const ReadCapture capture = read_both(bytes_of(good + line + good));
    EXPECT_EQ(capture.frames.size(), 1U);
    EXPECT_EQ(capture.error, error);
  }
}

TEST(Candump, ALastLineWithoutItsEndIsCut) {
  const ReadCapture capture = read_both(bytes_of("(1.5) can0 5FF#0034\n(1.6) can0 5FF#00"));
  EXPECT_EQ(capture.error, "");
  EXPECT_EQ(capture.frames.size(), 1U) << "0034 may have been cut to 00";
  ASSERT_TRUE(capture.truncation);
  EXPECT_EQ(capture.truncation->captured, 17U);
  EXPECT_FALSE(read_both(bytes_of("(1.5) can0 5FF#0034\n  ")).truncation);
}

TEST(Candump, EndlessLinesAreRefused) {
  const std::string text = "(1.5) can0 5FF#0034\n" + std::string(70'000, 'a') + "\n";
  EXPECT_EQ(read_both(bytes_of(text)).error, "-:2: a line of more than 65536 bytes");
}

TEST(Asc, VectorAbsolute) {
  const ReadCapture capture = read_both(
      bytes_of("date Sun Nov 22 09:31:45.111 AM 2026\n"
               "base hex  timestamps absolute\n"
               "internal events logged\n"
               "// version 9.0.0\n"
               "Begin Triggerblock Tue Nov 14 10:13:22.501 PM 2023\n"
               " 0.000000 Start of measurement\n"
               "   0.015991 CAN 1 Status:chip status error active\n"
               "   1.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%\n"
               " 2.501247 1  5FB             Rx   d 3 00 CB 00  Length = 0 BitCount = 0 ID = 1531\n"
               " 2.501248 2  18FEF100x       Tx   d 2 AB CD\n"
               " 2.501249 1  5FC             Rx   r\n"
               " 2.501250 1  ErrorFrame ECC: 10100010\n"
               " 2.501251 1  EngineData      Rx   d 1 07  Length = 0 BitCount = 0 ID = 100\n"
               " 2.501252 CANFD 1 Rx 12 Name 1 0 9 12 00 01 02 03 04 05 06 07 08 09 0A 0B 0 0 1000 0 0 0 0 0\n"
               " 2.501253 2  5FF             TxRq d 1 00\n"
               "End TriggerBlock\n"));
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 6U);
  EXPECT_EQ(capture.format, "Vector ASC");
  EXPECT_EQ(show(capture.frames[0]), "5FB  00 CB 00");
  // 2023-11-14 22:13:22.501 UTC and 2.501247 s.
  EXPECT_EQ(capture.frames[0].raw.time_ns, 1'700'000'002 * kSecond + 501'000'000 + 2'501'247'000);
  EXPECT_EQ(show(capture.frames[1]), "18FEF100 x AB CD");
  EXPECT_EQ(capture.frames[1].raw.interface_id, 1U);
  EXPECT_EQ(capture.interfaces[1].name, "CAN 2");
  EXPECT_EQ(show(capture.frames[2]), "5FC r");
  EXPECT_EQ(show(capture.frames[3]), "0 e 00 00 00 00 00 00 00 00");
  EXPECT_EQ(show(capture.frames[4]), "64  07");
  EXPECT_EQ(show(capture.frames[5]), "malformed 7");
  EXPECT_EQ(capture.frames[5].bytes.size(), 8U + 12U);
}

TEST(Asc, RelativeDecimalAndGermanDates) {
  const ReadCapture capture =
      read_both(bytes_of("date Die Okt 14 22:13:22 2025\n"
                         "base dec  timestamps relative\n"
                         "no internal events logged\n"
                         "   1.000 1  1535            Rx   d 2 10 255\n"
                         "   0.500 1  Statistic: D 0\n"
                         "   0.500 1  1535            Rx   d 1 99\n"));
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 2U);
  EXPECT_EQ(show(capture.frames[0]), "5FF  0A FF");
  EXPECT_EQ(capture.frames[0].raw.time_ns, 1'760'480'003 * kSecond);
  EXPECT_EQ(capture.frames[1].raw.time_ns, 1'760'480'004 * kSecond);
  EXPECT_EQ(capture.frames[0].raw.time_resolution_ns, 1'000'000U);
}

TEST(Asc, BrokenLines) {
  const std::string head = "date Tue Nov 14 22:13:22 2023\nbase hex  timestamps absolute\n";
  EXPECT_EQ(read_both(bytes_of(head + " 1.0 1 5FF Rx d 3 00 01\n")).error,
            "-:3: no CAN frame of an ASC log: fewer data bytes than its length says");
  EXPECT_EQ(read_both(bytes_of(head + " 1.0 1 Motor Rx d 1 00\n")).error,
            "-:3: no CAN frame of an ASC log: its identifier is a name; record with numeric identifiers");
}

// Found by fuzzing: the sum of date and time did not fit.
TEST(Asc, ATimeBeyondTheClock) {
  const std::string head = "date Tue Nov 14 22:13:22 2023\nbase hex  timestamps ";
  EXPECT_EQ(read_both(bytes_of(head + "absolute\n7777501252 1 5FF Rx d 0\n")).error,
            "-:3: no CAN frame of an ASC log: its time is beyond the year 2262");
  EXPECT_EQ(read_both(bytes_of(head + "relative\n7000000000 1 5FF Rx d 0\n7000000000 1 5FF Rx d 0\n")).error,
            "-:4: no CAN frame of an ASC log: its time is beyond the year 2262");
}

TEST(Trc, ATimeBeyondTheClock) {
  EXPECT_EQ(read_both(bytes_of(";$FILEVERSION=1.1\n;$STARTTIME=45244.5;\n;\n"
                               "     1) 7777501252000.0  Rx  0300  3  00 AB 01\n"))
                .error,
            "-:4: no line of a TRC log: its time is beyond the year 2262");
}

TEST(Trc, EveryVersion) {
  const std::string start = ";$STARTTIME=45244.5;\n;\n";  // 2023-11-14 12:00 UTC
  const std::int64_t noon = 1'699'963'200 * kSecond;
  struct Case {
    std::string text;
    std::int64_t time_ns;
  };
  const Case cases[] = {
      {";####\n;   Start time: 11.09.2002 16:00:20.682\n"
       "     1)      1841  0300  3  00 AB 01\n"
       "     2)      1842  0008  4  ERROR 00 19 08 08\n"
       "     3)      1843  FFFFFFFF  4  00 00 00 04 ------BUSLIGHT\n"
       "     4)      1844  18FEF100  3  RTR\n",
       1'841'000'000},
      {";$FILEVERSION=1.1\n" + start +
           "     1)      1841.0  Rx         0300  3  00 AB 01\n"
           "     2)      1842.0  Error      0008  4  00 19 08 08\n"
           "     3)      1843.0  Warng  FFFFFFFF  4  00 00 00 04  BUSLIGHT\n"
           "     4)      1844.0  Tx     18FEF100  3  RTR\n",
       noon + 1'841'000'000},
      {";$FILEVERSION=1.2\n" + start +
           "     1)      1841.000  1  Rx         0300  3  00 AB 01\n"
           "     2)      1842.000  1  Error      0008  4  00 19 08 08\n"
           "     3)      1843.000  1  Warng  FFFFFFFF  4  00 00 00 04  BUSLIGHT\n"
           "     4)      1844.000  1  Rx     18FEF100  3  RTR\n",
       noon + 1'841'000'000},
      {";$FILEVERSION=1.3\n" + start +
           "     1)      1841.000 1  Rx        0300 -  3    00 AB 01\n"
           "     2)      1842.000 1  Error     0008 -  4    00 19 08 08\n"
           "     3)      1843.000 1  Warng FFFFFFFF -  4    00 00 00 04 BUSLIGHT\n"
           "     4)      1844.000 1  Rx    18FEF100 -  3    RTR\n",
       noon + 1'841'000'000},
      {";$FILEVERSION=2.0\n" + start +
           ";$COLUMNS=N,O,T,I,d,l,D\n"
           "      1      1841.000 DT     0300 Rx 3  00 AB 01\n"
           "      2      1842.000 ER          Rx 5  04 00 02 00 00\n"
           "      3      1843.000 ST          Rx    00 00 00 08\n"
           "      4      1844.000 RR 18FEF100 Rx 3\n",
       noon + 1'841'000'000},
      {";$FILEVERSION=2.1\n" + start +
           ";$COLUMNS=N,O,T,B,I,d,R,L,D\n"
           "      1      1841.000 DT 1      0300 Rx -  3    00 AB 01\n"
           "      2      1842.000 ER 1         - Rx -  5    04 00 02 00 00\n"
           "      3      1843.000 ST 1         - Rx -  4    00 00 00 08\n"
           "      4      1844.000 RR 1  18FEF100 Rx -  3\n",
       noon + 1'841'000'000},
  };
  for (const Case& test : cases) {
    const ReadCapture capture = read_both(bytes_of(test.text));
    ASSERT_EQ(capture.error, "") << test.text;
    ASSERT_EQ(capture.frames.size(), 3U) << test.text;
    EXPECT_EQ(capture.format, "PEAK TRC");
    EXPECT_EQ(show(capture.frames[0]), "300  00 AB 01");
    EXPECT_EQ(capture.frames[0].raw.time_ns, test.time_ns);
    EXPECT_EQ(show(capture.frames[1]), "0 e 00 00 00 00 00 00 00 00");
    EXPECT_EQ(show(capture.frames[2]), "18FEF100 xr");
    EXPECT_EQ(capture.frames[2].bytes[4], 3);
  }
}

TEST(Trc, FdAndBroken) {
  const std::string head = ";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,l,D\n";
  const ReadCapture fd = read_both(
      bytes_of(head + "      2      1753.227 FB 2     0400 Tx -  9    01 02 03 04 05 06 07 08 09 0A 0B 0C\n"));
  ASSERT_EQ(fd.frames.size(), 1U) << fd.error;
  EXPECT_EQ(fd.frames[0].bytes.size(), 8U + 12U);
  EXPECT_EQ(read_both(bytes_of(head + " 1 1.0 DT 1 0300 Rx - 3 00 01\n")).error,
            "-:3: no line of a TRC log: fewer data bytes than its length says");
  EXPECT_EQ(read_both(bytes_of(head + " 1 1.0 DT 1 0900 Rx - 3 00 01 02\n")).error,
            "-:3: no line of a TRC log: an identifier of 4 digits above 7FF");
  EXPECT_EQ(read_both(bytes_of(";$FILEVERSION=9.9\n")).error,
            "-:1: no line of a TRC log: its file version is not known");
}

TEST(Csv, PythonCanSavvyCanAndByHand) {
  const ReadCapture python =
      read_both(bytes_of("timestamp,arbitration_id,extended,remote,error,dlc,data\n"
                         "1700000002.501431,0x5ff,0,0,0,7,ADQSRSMAAA==\n"
                         "1700000003.0,0x1,1,0,0,4,gABBQQ==\n"
                         "1700000005.0012,0x123,0,1,0,3,\n"));
  ASSERT_EQ(python.error, "");
  ASSERT_EQ(python.frames.size(), 3U);
  EXPECT_EQ(show(python.frames[0]), "5FF  00 34 12 45 23 00 00");
  EXPECT_EQ(python.frames[0].raw.time_ns, 1700000002 * kSecond + 501'431'000);
  EXPECT_EQ(show(python.frames[1]), "1 x 80 00 41 41");
  EXPECT_EQ(show(python.frames[2]), "123 r");
  EXPECT_EQ(python.format, "CSV");

  const ReadCapture savvy =
      read_both(bytes_of("Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
                         "166064000,0000021A,false,Rx,0,3,FE,36,12,,,,,\n"
                         "166064100,18FEF100,true,Rx,1,8,01,02,03,04,05,06,07,08\n"));
  ASSERT_EQ(savvy.error, "");
  ASSERT_EQ(savvy.frames.size(), 2U);
  EXPECT_EQ(show(savvy.frames[0]), "21A  FE 36 12");
  EXPECT_EQ(savvy.frames[0].raw.time_ns, 166'064'000'000);
  EXPECT_EQ(savvy.frames[1].raw.interface_id, 1U);
  EXPECT_EQ(savvy.interfaces[1].name, "1");

  const ReadCapture hand =
      read_both(bytes_of("\xEF\xBB\xBF"
                         "Time [ms];CAN-ID;Comment;Data\r\n"
                         "\"12.5\";5FF;\"poll; first\";\"00 34 12\"\r\n"
                         "13,25;18FEF100;;003412AB\r\n"));
  ASSERT_EQ(hand.error, "");
  ASSERT_EQ(hand.frames.size(), 2U);
  EXPECT_EQ(show(hand.frames[0]), "5FF  00 34 12");
  EXPECT_EQ(hand.frames[0].raw.time_ns, 12'500'000);
  EXPECT_EQ(show(hand.frames[1]), "18FEF100 x 00 34 12 AB");
  EXPECT_EQ(hand.frames[1].raw.time_ns, 13'250'000);
}

TEST(Csv, BrokenRows) {
  const std::string head = "timestamp,id,dlc,data\n";
  const std::pair<std::string, std::string> cases[] = {
      {"x,1,1,00\n", "its time is no number"},
      {"1,zz,1,00\n", "its identifier is no hexadecimal number"},
      {"1,7FF,2,00\n", "data that are neither hexadecimal nor base64"},
      {"1,7FF,9999,00\n", "its length is no number up to 64"},
      {"1,FFFFFFFF,1,00\n", "an identifier that is too large"},
      {"1\n", "fewer columns than the header"},
  };
  for (const auto& [row, error] : cases)
    EXPECT_EQ(read_both(bytes_of(head + row)).error, "-:2: no row of a table of CAN frames: " + error);
}

}  // namespace
}  // namespace servotrace::test
