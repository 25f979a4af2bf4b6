#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/world/perception/depth_png.h>

#include <random>

#include "common/temporary_folder.h"
#include "world/perception/png_by_hand.h"

namespace locograph {
namespace {

using test::png_by_hand;
using test::png_text_chunk;
using test::TemporaryFolder;

/// One row of two pixels, 300 mm and nothing.
std::string small_png(const std::string& before = "") {
  return png_by_hand({.width = 2}, test::grey_row({300, 0}), before);
}

std::string png_error_of(const std::filesystem::path& path) {
  try {
    load_depth_png(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

TEST(DepthPng, WhatWasSavedIsLoadedBitForBitWithItsCameraAndStamp) {
  const TemporaryFolder folder;
  DepthCamera camera = depth_camera("head", 3, 61, 40, 1.3);
  camera.fy = 1.0 / 3.0 * camera.fx;
  DepthImage image{.stamp_s = 0.1 + 0.2, .camera = 2, .width = 61, .height = 40};
  std::mt19937 random(7);
  for (int i = 0; i < 61 * 40; ++i) {
    image.depth_mm.push_back(static_cast<std::uint16_t>(random() & 0xffff));
  }
  const auto path = folder.file("a.png");
  save_depth_png(path, image, camera);
  const DepthPng png = load_depth_png(path);
  EXPECT_EQ(png.image.width, 61);
  EXPECT_EQ(png.image.height, 40);
  EXPECT_EQ(png.image.depth_mm, image.depth_mm);
  EXPECT_TRUE(png.stamped);
  EXPECT_EQ(png.image.stamp_s, image.stamp_s);
  ASSERT_TRUE(png.camera.has_value());
  EXPECT_EQ(png.camera->name, "head");
  EXPECT_EQ(png.camera->fx, camera.fx);
  EXPECT_EQ(png.camera->fy, camera.fy);
  EXPECT_EQ(png.camera->cx, camera.cx);
  EXPECT_EQ(png.camera->range_max_m, camera.range_max_m);
  save_depth_png(folder.file("b.png"), image, camera);
  EXPECT_EQ(read_file(path), read_file(folder.file("b.png")));
}

TEST(DepthPng, FilesFromElsewhereNeedNoTexts) {
  const TemporaryFolder folder;
  const DepthPng png = load_depth_png(folder.write(
      "a.png", png_by_hand({.width = 3, .height = 2},
                           test::grey_row({1, 256, 65535}) + test::grey_row({0, 7, 1000}),
                           png_text_chunk("Software", "someone's"))));
  EXPECT_EQ(png.image.depth_mm, (std::vector<std::uint16_t>{1, 256, 65535, 0, 7, 1000}));
  EXPECT_FALSE(png.stamped);
  EXPECT_FALSE(png.camera.has_value());
}

TEST(DepthPng, OtherKindsOfImagesAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& what) {
    const std::string error = png_error_of(folder.write("a.png", content));
    EXPECT_NE(error.find(what), std::string::npos) << error;
  };
  refused("", "no PNG, or truncated");
  refused("P5\n2 1\n65535\n", "no PNG, or truncated");
  refused(png_by_hand({.width = 2, .bits = 8}, std::string(3, '\0')), "8 bits in grey");
  refused(png_by_hand({.width = 2, .colour = 2}, std::string(13, '\0')), "16 bits in colour");
  refused(png_by_hand({.width = 2, .bits = 8, .colour = 6}, std::string(9, '\0')), "in colour");
  refused(png_by_hand({.width = 2, .interlaced = 1}, std::string(8, '\0')), "interlaced");
  refused(png_by_hand({.width = 0}, ""), "no readable PNG");
  refused(png_by_hand({.width = 4097}, ""), "4097 x 1 pixels, expected at most 4096");
  refused(png_by_hand({.width = 2, .height = 0x7fffffff}, ""), "2 x 2147483647 pixels");
  refused(png_by_hand({.width = 0xffffffff, .height = 0xffffffff}, ""), "no readable PNG");
  refused(png_by_hand({.width = 4096, .height = 4096}, "few"), "no readable PNG");
  EXPECT_NE(png_error_of(folder.file("none.png")).find("cannot be opened"), std::string::npos);
  EXPECT_NE(png_error_of(folder.path()).find("is a folder"), std::string::npos);
}

TEST(DepthPng, EveryCutAndEveryDamagedByteIsAnError) {
  const TemporaryFolder folder;
  const std::string good = small_png(png_text_chunk("stamp_s", "0.5"));
  ASSERT_EQ(load_depth_png(folder.write("good.png", good)).image.stamp_s, 0.5);
  for (std::size_t size = 0; size < good.size(); ++size) {
    png_error_of(folder.write("cut.png", good.substr(0, size)));
  }
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x20);
    png_error_of(folder.write("damaged.png", damaged));
  }
}

TEST(DepthPng, PromisesOfAChunkAreNotBelieved) {
  const TemporaryFolder folder;
  std::string huge = small_png(png_text_chunk("stamp_s", "0.5"));
  const std::size_t size = huge.find("tEXt") - 4;
  huge.replace(size, 4, test::big_endian(0x7ffffff0));
  EXPECT_NE(png_error_of(folder.write("huge.png", huge)).find("truncated"), std::string::npos);
}

TEST(DepthPng, TextsThatMakeNoSenseAreErrors) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& chunks, const std::string& what) {
    const std::string error = png_error_of(folder.write("a.png", small_png(chunks)));
    EXPECT_NE(error.find(what), std::string::npos) << error;
  };
  const auto camera = [](const std::string& fx, const std::string& range_min) {
    return png_text_chunk("camera", "head") + png_text_chunk("fx", fx) + png_text_chunk("fy", "2") +
           png_text_chunk("cx", "0.5") + png_text_chunk("cy", "0") +
           png_text_chunk("range_min_m", range_min) + png_text_chunk("range_max_m", "6");
  };
  EXPECT_EQ(load_depth_png(folder.write("a.png", small_png(camera("2", "0")))).camera->fx, 2.0);
  refused(png_text_chunk("stamp_s", "0.5s"), "the text 'stamp_s' is '0.5s'");
  refused(png_text_chunk("stamp_s", "nan"), "the text 'stamp_s' is 'nan'");
  refused(png_text_chunk("stamp_s", "1") + png_text_chunk("stamp_s", "1"), "a second text");
  refused(png_text_chunk("camera", "head"), "no text 'fx'");
  refused(png_text_chunk("fx", "2"), "no text 'camera'");
  refused(camera("0", "0"), "focal lengths");
  refused(camera("2", "7"), "depths from 7");
  refused(camera("\x1b[2J", "0"), "the text 'fx' is '\\x1b[2J'");
}

TEST(DepthPng, ImagesThatDoNotFitTheirCameraAreNotSaved) {
  const TemporaryFolder folder;
  const DepthCamera camera = depth_camera("head", 0, 2, 1, 1.0);
  DepthImage image{.width = 2, .height = 1, .depth_mm = {1, 2}};
  image.width = 1;
  EXPECT_THROW(save_depth_png(folder.file("a.png"), image, camera), Error);
  image.width = 2;
  image.stamp_s = std::nan("");
  EXPECT_THROW(save_depth_png(folder.file("a.png"), image, camera), Error);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace locograph
