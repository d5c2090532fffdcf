// The descriptors of this process: how many it may have, and some that peers do not get.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate {

/// Raises the limit of open files as far as this process may, to the hard limit. Returns it.
std::size_t raise_open_files_limit();

/// Descriptors that this process has open now.
std::size_t count_open_files();

/// How many peers each of so many sockets may have, within `limit` descriptors of which `in_use`
/// are taken. Leaves kKeptFromPeers. 0 = there is no room.
std::size_t peers_within(std::size_t limit, std::size_t in_use, std::size_t sockets);

/// Of the limit, kept for what this process itself opens: files to be read again, and connections
/// that are accepted before the PeerGuard can cut them.
inline constexpr std::size_t kKeptFromPeers = 48;

/// From now on a connection that would take one of the last descriptors below `limit` is closed as
/// it is accepted. Otherwise libzmq 4.3 would abort the process: it takes a lack of descriptors at
/// an ipc endpoint for an error of its own.
void turn_peers_away_at(std::size_t limit);

/// Connections that were closed so.
std::uint64_t peers_turned_away();

}  // namespace palpate
