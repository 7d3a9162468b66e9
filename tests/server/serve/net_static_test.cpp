// tests/server/serve/net_static_test.cpp: only the page's files are served, for any path.
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>

namespace server::net::test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// web/ with the page in it, and a secret beside it.
class NetStatic : public testing::Test {
 protected:
  NetStatic() {
    std::string name = (fs::temp_directory_path() / "tautline_static_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    fs::create_directories(folder_ / "web/assets");
    write(folder_ / "secret.txt", "secret");
    write(folder_ / "web/index.html", "<!doctype html>");
    write(folder_ / "web/assets/main.js", "let x = 1;");
    write(folder_ / "web/part-ABCDEFG2.js", "plain");
    write(folder_ / "web/part-ABCDEFG2.js.gz", "zipped");
    write(folder_ / "web/part-ABCDEFG2.js.br", "brotli");
    write(folder_ / "web/.hidden", "secret");
    fs::create_symlink("../secret.txt", folder_ / "web/leak.txt");
    fs::create_symlink("assets/main.js", folder_ / "web/alias.js");
    ServerOptions options;
    options.web_root = folder_ / "web";
    running_.emplace(options);
    running_->start();
  }
  ~NetStatic() override {
    running_.reset();
    fs::remove_all(folder_);
  }
  Answer get(const std::string& path, const std::string& headers = "") const {
    return ask(running_->port(), get_request(path, headers));
  }

  fs::path folder_{};
  std::optional<RunningServer> running_{};
};

TEST_F(NetStatic, ServesThePageWithItsTypes) {
  EXPECT_EQ("<!doctype html>", get("/").body);
  EXPECT_EQ("text/html; charset=utf-8", get("/index.html").headers.at("Content-Type"));
  EXPECT_EQ("text/html; charset=utf-8", get("/?view=runs").headers.at("Content-Type"));
  const Answer script = get("/assets/main.js");
  EXPECT_EQ("let x = 1;", script.body);
  EXPECT_EQ("text/javascript; charset=utf-8", script.headers.at("Content-Type"));
  EXPECT_EQ("nosniff", script.headers.at("X-Content-Type-Options"));
  EXPECT_EQ("let x = 1;", get("/alias.js").body);
}

TEST_F(NetStatic, NothingOutsideTheRoot) {
  for (const char* path : {"/../secret.txt",
                           "/%2e%2e/secret.txt",
                           "/..%2fsecret.txt",
                           "/assets/../../secret.txt",
                           "/assets/..%5c..%5csecret.txt",
                           "/..\\secret.txt",
                           "/%252e%252e/secret.txt",
                           "/leak.txt",
                           "/.hidden",
                           "/assets/./main.js",
                           "/assets",
                           "/assets/",
                           "//etc/passwd",
                           "/etc/passwd",
                           "/main.js%20",
                           "/index.html/",
                           "/none",
                           "/..;/secret.txt"}) {
    const Answer answer = get(path);
    EXPECT_EQ(404, answer.status) << path;
    EXPECT_EQ(std::string::npos, answer.body.find("\"secret\"")) << path;
  }
  // Malformed: an encoded NUL, overlong UTF-8 for "../".
  EXPECT_EQ(400, get("/index.html%00.js").status);
  EXPECT_EQ(400, get("/%c0%ae%c0%ae/secret.txt").status);
}

TEST_F(NetStatic, AnUnchangedFileIsNotSentAgain) {
  const std::string tag = get("/").headers.at("ETag");
  Client client(running_->port());
  client.send(get_request("/", "If-None-Match: " + tag + "\r\n"));
  EXPECT_EQ(304, read_answer(client).status);
  write(folder_ / "web/index.html", "<!doctype html><p>new");
  client.send(get_request("/", "If-None-Match: " + tag + "\r\n"));
  EXPECT_EQ("<!doctype html><p>new", read_answer(client).body);
}

TEST_F(NetStatic, TheBestCodingThatTheClientTakesIsSent) {
  const auto part = [&](const std::string& accepts) {
    return get("/part-ABCDEFG2.js", accepts.empty() ? "" : "Accept-Encoding: " + accepts + "\r\n");
  };
  for (const auto& [accepts, body] : {std::pair{"", "plain"},
                                      {"gzip, deflate", "zipped"},
                                      {"gzip, deflate, br, zstd", "brotli"},
                                      {"br;q=0, GZIP;q=0.5", "zipped"},
                                      {"gzip;q=0.0", "plain"},
                                      {"identity", "plain"},
                                      {"xgzip", "plain"}}) {
    const Answer answer = part(accepts);
    EXPECT_EQ(body, answer.body) << accepts;
    EXPECT_EQ("Accept-Encoding", answer.headers.at("Vary"));
    EXPECT_EQ("text/javascript; charset=utf-8", answer.headers.at("Content-Type"));
    const bool coded = answer.headers.count("Content-Encoding") > 0;
    EXPECT_EQ(answer.body != "plain", coded) << accepts;
  }
  EXPECT_EQ("br", part("br").headers.at("Content-Encoding"));
  EXPECT_NE(part("br").headers.at("ETag"), part("gzip").headers.at("ETag"));
  EXPECT_EQ("let x = 1;", get("/assets/main.js", "Accept-Encoding: br, gzip\r\n").body);
  const std::string tag = part("gzip").headers.at("ETag");
  EXPECT_EQ(304, part("gzip\r\nIf-None-Match: " + tag).status);
  EXPECT_EQ(200, part("br\r\nIf-None-Match: " + tag).status);
}

TEST_F(NetStatic, OnlyAFileNamedByItsContentIsKeptForEver) {
  const auto control = [&](const char* path) { return get(path).headers.at("Cache-Control"); };
  EXPECT_EQ("public, max-age=31536000, immutable", control("/part-ABCDEFG2.js"));
  for (const char* path : {"/", "/assets/main.js", "/alias.js"}) {
    EXPECT_EQ("no-cache", control(path)) << path;
  }
}

TEST_F(NetStatic, FilesAreReadOnly) {
  const Answer answer = ask(running_->port(), post_request("/index.html", "{}"));
  EXPECT_EQ(405, answer.status);
  EXPECT_EQ("GET, HEAD", answer.headers.at("Allow"));
}

TEST_F(NetStatic, ALargeFileReachesASlowReaderWhole) {
  const std::string large(8'000'000, 'x');
  write(folder_ / "web/large.txt", large);
  Client slow(running_->port(), 4096);
  slow.send(get_request("/large.txt"));
  EXPECT_EQ("<!doctype html>", get("/").body);
  EXPECT_EQ(large, read_answer(slow).body);
}

TEST(NetStaticSetup, AMissingPageIsReported) {
  RunningServer running;
  running.start();
  const Answer answer = ask(running.port(), get_request("/"));
  EXPECT_EQ(404, answer.status);
  EXPECT_NE(std::string::npos, answer.body.find("has not been built"));
}

}  // namespace
}  // namespace server::net::test
