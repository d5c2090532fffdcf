#include "node/wire/curve_keys.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string_view>

#include "node/files/bounded_file.h"
#include "node/files/trimmed.h"
#include "node/files/written_file.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

constexpr std::size_t kKeyBytes = 32;
constexpr std::size_t kZ85Length = 40;
constexpr std::string_view kPublicKey = "public-key";
constexpr std::string_view kSecretKey = "secret-key";
constexpr std::string_view kBlanks = " \t\r";
// Upper limits, larger than any list of keys that a person keeps: a wrong path must not make us
// read a huge file.
constexpr std::size_t kMaxKeys = 10000;
constexpr std::size_t kMostKeyFileBytes = std::size_t{4} << 20;

bool is_z85_key(const std::string& text) {
  std::array<std::uint8_t, kKeyBytes> bytes{};
  return text.size() == kZ85Length && zmq_z85_decode(bytes.data(), text.c_str()) != nullptr;
}

struct KeyLines {
  std::vector<AllowedClient> public_keys;
  std::vector<std::size_t> line_numbers;  // of the public keys
  std::vector<std::string> secret_keys;
};

std::string_view without_blanks(std::string_view text) { return trimmed(text, kBlanks); }

std::string at_line(const std::string& path, std::size_t number, std::string_view what) {
  return (path + ":" + std::to_string(number) + ": ").append(what);
}

// True if the line is a bare key, perhaps followed by rights. No key begins with '#': its first
// five characters would be a number beyond 32 bits in Z85.
bool is_bare_key(std::string_view line) {
  return is_z85_key(std::string(line.substr(0, line.find_first_of(kBlanks))));
}

// The parts of a line "NAME = VALUE" or "NAME VALUE". The value may be in quotes; `rest` is what
// follows it.
struct Setting {
  std::string_view name;
  std::string_view value;
  std::string_view rest;
};

Setting setting_of(std::string_view line) {
  const std::size_t end = line.find_first_of(" \t=");
  if (end == std::string_view::npos) return {line, {}, {}};
  std::string_view value = without_blanks(line.substr(end));
  // A key may itself begin with '='.
  const bool is_assigned = value.starts_with('=') && (line[end] == '=' || !is_bare_key(value));
  if (is_assigned) value = without_blanks(value.substr(1));
  const bool is_quoted = value.starts_with('"') || value.starts_with('\'');
  const std::size_t closing =
      is_quoted ? value.find(value.front(), 1) : value.find_first_of(kBlanks);
  if (closing == std::string_view::npos) return {line.substr(0, end), value, {}};
  return {line.substr(0, end), value.substr(is_quoted ? 1 : 0, closing - (is_quoted ? 1 : 0)),
          without_blanks(value.substr(closing + (is_quoted ? 1 : 0)))};
}

// Parses "probes=a,b". Returns an empty string or an error.
std::string read_rights(std::string_view text, AllowedClient* client) {
  constexpr std::string_view kProbes = "probes=";
  if (text.empty()) return {};
  if (text.starts_with("groups=")) {
    return "groups=: what a client reads cannot be restricted; give its readers a recognizer of "
           "their own";
  }
  if (!text.starts_with(kProbes) || text.find_first_of(kBlanks) != std::string_view::npos) {
    return "expected nothing or probes=NAME,NAME after the key";
  }
  client->probes.emplace();
  for (std::string_view names = text.substr(kProbes.size()); !names.empty();) {
    const std::size_t comma = names.find(',');
    const std::string_view name = names.substr(0, comma);
    const bool ends_in_comma = comma != std::string_view::npos && comma + 1 == names.size();
    if (!is_valid_name(name) || ends_in_comma) {
      return "probes=: names are 1 to 64 of A-Z a-z 0-9 _ . -, with commas between";
    }
    client->probes->emplace(name);
    names = comma == std::string_view::npos ? std::string_view() : names.substr(comma + 1);
  }
  return {};
}

Result<KeyLines> read_key_lines(const std::string& path) {
  const Result<std::string> text = read_bounded(path, kMostKeyFileBytes);
  if (!text) return Result<KeyLines>::fail(text.error);
  std::istringstream file(*text.value);
  KeyLines keys;
  std::string line;
  bool in_metadata = false;  // its content is not checked
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const std::string_view said = without_blanks(line);
    if (said.empty() || said.front() == '#') continue;
    const bool is_bare = is_bare_key(said);
    const bool is_section = line.front() != ' ' && line.front() != '\t';
    if (is_section) in_metadata = said == "metadata";
    if (in_metadata || (is_section && said == "curve")) continue;
    const Setting setting = is_bare ? Setting{kPublicKey, said.substr(0, kZ85Length),
                                              without_blanks(said.substr(kZ85Length))}
                                    : setting_of(said);
    const bool is_public = setting.name == kPublicKey;
    std::string key(setting.value);
    if ((!is_public && (setting.name != kSecretKey || !setting.rest.empty())) || !is_z85_key(key) ||
        keys.public_keys.size() >= kMaxKeys) {
      return Result<KeyLines>::fail(
          at_line(path, number, "expected public-key = \"KEY\" or secret-key = \"KEY\""));
    }
    if (!is_public) {
      keys.secret_keys.push_back(std::move(key));
      continue;
    }
    AllowedClient client{std::move(key), std::nullopt};
    if (const std::string error = read_rights(setting.rest, &client); !error.empty()) {
      return Result<KeyLines>::fail(at_line(path, number, error));
    }
    keys.public_keys.push_back(std::move(client));
    keys.line_numbers.push_back(number);
  }
  return Result<KeyLines>::ok(std::move(keys));
}

std::string certificate(const char* comment, const CurveKeyPair& keys, bool with_secret) {
  std::string text = std::string("# palpate: ") + comment + "\nmetadata\ncurve\n";
  const auto add = [&text](std::string_view name, const std::string& key) {
    text += "    " + std::string(name) + " = \"" + key + "\"\n";
  };
  add(kPublicKey, keys.public_key);
  if (with_secret) add(kSecretKey, keys.secret_key);
  return text;
}

std::string write_new_file(const std::string& path, mode_t mode, const std::string& text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (fd < 0) return path + ": " + std::strerror(errno);
  errno = 0;
  const ssize_t written = ::write(fd, text.data(), text.size());
  const bool complete = written == static_cast<ssize_t>(text.size());
  if (::close(fd) != 0 || !complete) {
    std::string why = cannot_be_written(path);
    ::unlink(path.c_str());
    return why;
  }
  return {};
}

}  // namespace

bool curve_available() { return zmq_has("curve") == 1; }

Result<CurveKeyPair> generate_curve_keys() {
  std::array<char, kZ85Length + 1> public_key{};
  std::array<char, kZ85Length + 1> secret_key{};
  if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) {
    return Result<CurveKeyPair>::fail(std::string("no CURVE keys: ") + zmq_strerror(zmq_errno()));
  }
  return Result<CurveKeyPair>::ok({public_key.data(), secret_key.data()});
}

std::string write_curve_keys(const CurveKeyPair& keys, const std::string& secret_path,
                             const std::string& public_path) {
  constexpr mode_t kPrivate = 0600;
  constexpr mode_t kShared = 0644;
  if (std::string error = write_new_file(secret_path, kPrivate,
                                         certificate("keep this file to yourself", keys, true));
      !error.empty()) {
    return error;
  }
  std::string error =
      write_new_file(public_path, kShared, certificate("give this to the other side", keys, false));
  if (!error.empty()) ::unlink(secret_path.c_str());
  return error;
}

Result<CurveKeyPair> read_curve_keys(const std::string& secret_path) {
  using Keys = Result<CurveKeyPair>;
  struct stat info {};
  if (::stat(secret_path.c_str(), &info) != 0) {
    return Keys::fail(secret_path + ": " + std::strerror(errno));
  }
  // Looked at first: a public key file may well be read by others, and is none to keep from them.
  Result<KeyLines> lines = read_key_lines(secret_path);
  if (!lines) return Keys::fail(lines.error);
  if (lines.value->secret_keys.empty()) {
    return Keys::fail(secret_path + ": holds no secret key; give the secret key file");
  }
  // systemd makes a credential readable to us by an access list, whose mask appears as the group's
  // rights.
  const char* credentials = std::getenv("CREDENTIALS_DIRECTORY");
  const bool granted =
      credentials != nullptr && secret_path.starts_with(std::string(credentials) + "/");
  if ((info.st_mode & (granted ? S_IWGRP | S_IRWXO : S_IRWXG | S_IRWXO)) != 0) {
    return Keys::fail(secret_path + ": others may read it; chmod 600 it");
  }
  if (lines.value->secret_keys.size() != 1 || lines.value->public_keys.size() > 1) {
    return Keys::fail(secret_path + ": expected one secret key");
  }
  CurveKeyPair keys;
  keys.secret_key = lines.value->secret_keys.front();
  std::array<char, kZ85Length + 1> public_key{};
  if (zmq_curve_public(public_key.data(), keys.secret_key.c_str()) != 0) {
    return Keys::fail(secret_path + ": " + zmq_strerror(zmq_errno()));
  }
  keys.public_key = public_key.data();
  if (!lines.value->public_keys.empty() &&
      lines.value->public_keys.front().public_key != keys.public_key) {
    return Keys::fail(secret_path + ": public and secret key do not belong together");
  }
  return Keys::ok(std::move(keys));
}

Result<std::vector<AllowedClient>> read_allowed_clients(const std::string& path) {
  using Clients = Result<std::vector<AllowedClient>>;
  Result<KeyLines> lines = read_key_lines(path);
  if (!lines) return Clients::fail(lines.error);
  if (!lines.value->secret_keys.empty()) {
    return Clients::fail(path + ": holds a secret key; give the public key files only");
  }
  std::vector<AllowedClient> clients;
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < lines.value->public_keys.size(); ++i) {
    const AllowedClient& client = lines.value->public_keys[i];
    const auto [found, is_new] = index_of.try_emplace(client.public_key, i);
    if (is_new) {
      clients.push_back(client);
    } else if (lines.value->public_keys[found->second].probes != client.probes) {
      return Clients::fail(at_line(path, lines.value->line_numbers[i],
                                   "this key has other probes in line " +
                                       std::to_string(lines.value->line_numbers[found->second])));
    }
  }
  if (clients.empty()) return Clients::fail(path + ": no public key");
  return Clients::ok(std::move(clients));
}

Result<std::vector<std::string>> read_public_keys(const std::string& path) {
  using Keys = Result<std::vector<std::string>>;
  const Result<std::vector<AllowedClient>> clients = read_allowed_clients(path);
  if (!clients) return Keys::fail(clients.error);
  std::vector<std::string> keys;
  for (const AllowedClient& client : *clients.value) {
    if (client.probes) return Keys::fail(path + ": probes= is for a recognizer's list of clients");
    keys.push_back(client.public_key);
  }
  return Keys::ok(std::move(keys));
}

}  // namespace palpate
