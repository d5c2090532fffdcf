#include "node/wire/curve_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "node/client/connection.h"
#include "node/security/zap_handler.h"
#include "node/wire/path_lock.h"

namespace palpate {
namespace {

using ::testing::HasSubstr;

class CurveKeysTest : public ::testing::Test {
 protected:
  CurveKeysTest() : folder_(::testing::TempDir() + "palpate_keys_" + std::to_string(::getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~CurveKeysTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

 private:
  std::string folder_;
};

TEST_F(CurveKeysTest, WrittenKeysAreReadBack) {
  const Result<CurveKeyPair> keys = generate_curve_keys();
  ASSERT_TRUE(keys) << keys.error;
  ASSERT_EQ(write_curve_keys(*keys.value, path("a.key"), path("a.pub")), "");
  struct stat info {};
  ASSERT_EQ(::stat(path("a.key").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
  const Result<CurveKeyPair> again = read_curve_keys(path("a.key"));
  ASSERT_TRUE(again) << again.error;
  EXPECT_EQ(again.value->public_key, keys.value->public_key);
  EXPECT_EQ(again.value->secret_key, keys.value->secret_key);
  const Result<std::vector<std::string>> public_keys = read_public_keys(path("a.pub"));
  ASSERT_TRUE(public_keys) << public_keys.error;
  EXPECT_EQ(*public_keys.value, std::vector<std::string>{keys.value->public_key});
}

TEST_F(CurveKeysTest, NothingIsOverwrittenAndSecretsStaySecret) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  ASSERT_EQ(write_curve_keys(keys, path("a.key"), path("a.pub")), "");
  EXPECT_NE(write_curve_keys(keys, path("a.key"), path("b.pub")), "");
  EXPECT_NE(write_curve_keys(keys, path("b.key"), path("a.pub")), "");
  EXPECT_FALSE(std::filesystem::exists(path("b.key")));  // no half pair is left
  EXPECT_THAT(read_public_keys(path("a.key")).error, HasSubstr("secret"));
  ::chmod(path("a.key").c_str(), 0644);
  EXPECT_THAT(read_curve_keys(path("a.key")).error, HasSubstr("chmod 600"));
}

TEST_F(CurveKeysTest, APublicKeyFileIsNoSecretKey) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  ASSERT_EQ(write_curve_keys(keys, path("a.key"), path("a.pub")), "");
  EXPECT_THAT(read_curve_keys(path("a.pub")).error, HasSubstr("holds no secret key"));
}

TEST_F(CurveKeysTest, AClientNeedsTwoKeyFiles) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  ASSERT_EQ(write_curve_keys(keys, path("a.key"), path("a.pub")), "");
  EXPECT_TRUE(client::read_curve_client(path("a.key"), path("a.pub")));
  EXPECT_THAT(client::read_curve_client(path("a.key"), "").error,
              HasSubstr("the recognizer's public key file is not named"));
  EXPECT_THAT(client::read_curve_client("", path("a.pub")).error,
              HasSubstr("our own secret key file is not named"));
}

TEST_F(CurveKeysTest, TheGroupsRightsOfACredentialAreAnAccessList) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  ASSERT_EQ(write_curve_keys(keys, path("a.key"), path("a.pub")), "");
  ::chmod(path("a.key").c_str(), 0440);
  ::setenv("CREDENTIALS_DIRECTORY", path("elsewhere").c_str(), 1);
  EXPECT_THAT(read_curve_keys(path("a.key")).error, HasSubstr("chmod 600"));
  ::setenv("CREDENTIALS_DIRECTORY", std::filesystem::path(path("a.key")).parent_path().c_str(), 1);
  EXPECT_TRUE(read_curve_keys(path("a.key")));
  ::chmod(path("a.key").c_str(), 0444);
  EXPECT_THAT(read_curve_keys(path("a.key")).error, HasSubstr("chmod 600"));
  ::unsetenv("CREDENTIALS_DIRECTORY");
}

TEST_F(CurveKeysTest, BadFilesAreRefused) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  const CurveKeyPair other = *generate_curve_keys().value;
  const auto write = [&](const std::string& text) {
    std::ofstream(path("x")) << text;
    ::chmod(path("x").c_str(), 0600);
  };
  write("public-key " + other.public_key + "\nsecret-key " + keys.secret_key + "\n");
  EXPECT_THAT(read_curve_keys(path("x")).error, HasSubstr("do not belong together"));
  write("public-key " + keys.public_key + "\n");
  EXPECT_FALSE(read_curve_keys(path("x")));
  write("public-key tooshort\n");
  EXPECT_THAT(read_public_keys(path("x")).error, HasSubstr(":1:"));
  write("# nothing\n\n");
  EXPECT_FALSE(read_public_keys(path("x")));
  EXPECT_FALSE(read_public_keys(path("missing")));
  write("# two\npublic-key " + keys.public_key + "\r\npublic-key " + other.public_key);
  EXPECT_EQ(read_public_keys(path("x")).value->size(), 2U);
  const std::string zeros(40, '0');
  write("metadata\n    public-key = \"" + zeros +
        "\"\n    name = \"us\"\ncurve\n    public-key = '" + keys.public_key + "'\n");
  EXPECT_EQ(*read_public_keys(path("x")).value, std::vector<std::string>{keys.public_key});
  write("metadata\ncurve\n    public-key = \"" + keys.public_key + "\n");
  EXPECT_THAT(read_public_keys(path("x")).error, HasSubstr(":3:"));
  write("curve\n    colour = \"red\"\n");
  EXPECT_THAT(read_public_keys(path("x")).error, HasSubstr(":2:"));
}

TEST_F(CurveKeysTest, AKeyMayBeginWithAnEqualsSign) {
  const std::string key = "=" + std::string(39, '0');
  for (const std::string& line : {"public-key " + key, "public-key = " + key, "public-key=" + key,
                                  "public-key = \"" + key + "\"", key}) {
    std::ofstream(path("x")) << line << '\n';
    const Result<std::vector<std::string>> read = read_public_keys(path("x"));
    ASSERT_TRUE(read) << line << ": " << read.error;
    EXPECT_EQ(*read.value, std::vector<std::string>{key}) << line;
  }
  std::ofstream(path("x")) << "public-key=" << std::string(39, '0');  // one too short
  EXPECT_FALSE(read_public_keys(path("x")));
}

TEST_F(CurveKeysTest, AClientsProbesStandBehindItsKey) {
  const std::string left = generate_curve_keys().value->public_key;
  const std::string right = generate_curve_keys().value->public_key;
  const std::string third = generate_curve_keys().value->public_key;
  const auto read = [&](const std::string& text) {
    std::ofstream(path("x")) << text;
    return read_allowed_clients(path("x"));
  };
  const auto clients =
      read("# " + third + "\n" + left + "  probes=a,b.c\r\npublic-key = \"" + right +
           "\" probes=\ncurve\n    public-key = '" + third + "'\n" + left + " probes=b.c,a\n");
  ASSERT_TRUE(clients) << clients.error;
  ASSERT_EQ(clients.value->size(), 3U);  // said twice alike, once counted
  EXPECT_EQ((*clients.value)[0].public_key, left);
  EXPECT_EQ((*clients.value)[0].probes, (ProbeNames{"a", "b.c"}));
  EXPECT_EQ((*clients.value)[1].probes, ProbeNames());
  EXPECT_EQ((*clients.value)[2].public_key, third);
  EXPECT_EQ((*clients.value)[2].probes, std::nullopt);
  // Z85 cannot begin with '#': what looks like a comment is one.
  std::array<std::uint8_t, 32> bytes{};
  EXPECT_EQ(zmq_z85_decode(bytes.data(), ("#" + std::string(39, '0')).c_str()), nullptr);
  EXPECT_THAT(read(left + "\n" + right + " probes=a,\n").error, HasSubstr(":2: probes=: names"));
  for (const char* bad : {" probes=,a", " probes=a,,b", " probes=a b", " probe=a", " probes", " a",
                          " probes=a probes=b", " groups=a", "probes=a"}) {
    EXPECT_THAT(read(left + bad).error, HasSubstr(":1:")) << bad;
  }
  EXPECT_THAT(read(left + "\n" + left + " probes=a").error, HasSubstr(":2: this key has other"));
  // Rights are the list's: a recognizer's own public key has none.
  std::ofstream(path("x")) << left << " probes=a";
  EXPECT_THAT(read_public_keys(path("x")).error, HasSubstr("list of clients"));
}

TEST(ClientList, SaysWhoMayPublishAsWhom) {
  const std::string a(40, '0');
  const std::string b = "2" + std::string(39, '0');
  const std::string c = "1" + std::string(39, '0');
  const ClientList clients({{a, std::nullopt}, {b, ProbeNames{"left"}}, {c, ProbeNames{}}});
  EXPECT_TRUE(clients.sender(a).may_publish_as("left"));
  EXPECT_TRUE(clients.sender(b).may_publish_as("left"));
  EXPECT_FALSE(clients.sender(b).may_publish_as("lef"));
  EXPECT_FALSE(clients.sender(b).may_publish_as("right"));
  EXPECT_FALSE(clients.sender(c).may_publish_as("left"));
  EXPECT_FALSE(clients.sender("").may_publish_as("left"));
  EXPECT_TRUE(Sender().may_publish_as("left"));  // without CURVE
  EXPECT_TRUE(clients.allows_all_of(ClientList({{b, std::nullopt}})));
  EXPECT_FALSE(ClientList({{b, std::nullopt}}).allows_all_of(clients));
}

std::string raw(const std::string& z85) {
  std::array<std::uint8_t, 32> bytes{};
  EXPECT_NE(zmq_z85_decode(bytes.data(), z85.c_str()), nullptr);
  return {bytes.begin(), bytes.end()};
}

TEST(ZapReply, OnlyAListedCurveKeyOfOurDomainIsAllowed) {
  const CurveKeyPair keys = *generate_curve_keys().value;
  const CurveKeyPair other = *generate_curve_keys().value;
  const ClientList clients({{keys.public_key, std::nullopt}});
  const std::vector<std::string> good = {"1.0", "42",    "palpate",           "127.0.0.1",
                                         "",    "CURVE", raw(keys.public_key)};
  const auto reply = zap_reply(good, clients);
  EXPECT_EQ(reply[0], "1.0");
  EXPECT_EQ(reply[1], "42");
  EXPECT_EQ(reply[2], "200");
  EXPECT_EQ(reply[4], keys.public_key);  // whom libzmq tells us with each message
  const auto status_with = [&](std::size_t frame, const std::string& text) {
    std::vector<std::string> frames = good;
    frames[frame] = text;
    return zap_reply(frames, clients)[2];
  };
  EXPECT_EQ(status_with(0, "2.0"), "400");
  EXPECT_EQ(status_with(2, "other"), "400");
  EXPECT_EQ(status_with(5, "NULL"), "400");
  EXPECT_EQ(status_with(5, "PLAIN"), "400");
  EXPECT_EQ(status_with(6, raw(other.public_key)), "400");
  EXPECT_EQ(status_with(6, ""), "400");
  EXPECT_EQ(status_with(6, keys.public_key), "400");  // Z85 in place of bytes
  EXPECT_EQ(zap_reply(std::vector<std::string>{}, clients)[2], "400");
  std::vector<std::string> longer = good;
  longer.emplace_back("more");
  EXPECT_EQ(zap_reply(longer, clients)[2], "400");
}

TEST(PathLock, HasOneHolder) {
  const std::string path = ::testing::TempDir() + "palpate_lock_" + std::to_string(::getpid());
  {
    Result<PathLock> first = PathLock::acquire(path);
    ASSERT_TRUE(first) << first.error;
    EXPECT_FALSE(PathLock::acquire(path));
    const PathLock moved = std::move(*first.value);
    first.value.reset();
    EXPECT_FALSE(PathLock::acquire(path));
  }
  EXPECT_TRUE(PathLock::acquire(path));
  std::filesystem::remove(path + ".lock");
}

TEST(PathLock, PathsOfAddresses) {
  EXPECT_EQ(ipc_path("ipc:///run/x"), "/run/x");
  EXPECT_EQ(ipc_path("ipc://@abstract"), "");
  EXPECT_EQ(ipc_path("ipc://*"), "");
  EXPECT_EQ(ipc_path("tcp://127.0.0.1:1"), "");
}

}  // namespace
}  // namespace palpate
