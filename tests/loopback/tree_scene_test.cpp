// Scene files whose trees take the stack of the library that reads them: so deep, or of parts that are their own parts.
// The server starts without them and says so in a line.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <boost/crc.hpp>
#include <gtest/gtest.h>

#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 120s;

/// `begin` and `end` so many times around `inner`.
std::string nested(std::string const& begin, std::string const& inner, std::string const& end) {
    constexpr int deep = 200'000;
    std::string begins, ends;
    for (int i = 0; i < deep; ++i) {
        begins += begin;
        ends += end;
    }
    return begins + inner + ends;
}

std::string dae() {
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
           "<asset/><library_visual_scenes><visual_scene id=\"s\">" +
           nested("<node>", "", "</node>") +
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::string x3d() {
    return "<?xml version=\"1.0\"?><X3D profile=\"Interchange\" version=\"3.0\"><Scene>" +
           nested("<Group>", "", "</Group>") + "</Scene></X3D>";
}

std::string bvh() {
    return "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n" +
           nested("JOINT a\n{\nOFFSET 0 1 0\nCHANNELS 0\n", "End Site\n{\nOFFSET 0 1 0\n}\n", "}\n") +
           "}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n";
}

/// Two models, each of which is a child of the other.
std::string fbx() {
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
           "Objects:  {\n\tModel: 1, \"Model::a\", \"Null\" {\n\t}\n\tModel: 2, \"Model::b\", \"Null\" {\n\t}\n}\n"
           "Connections:  {\n\tC: \"OO\",1,0\n\tC: \"OO\",2,1\n\tC: \"OO\",1,2\n}\n";
}

/// A ZIP archive of files that are stored as they are.
std::string zip(std::vector<std::pair<std::string, std::string>> const& files) {
    auto const put = [](std::string& out, std::size_t bytes, std::size_t number) {
        for (std::size_t i = 0; i < bytes; ++i, number >>= 8U) {
            out += static_cast<char>(number);
        }
    };
    std::string out, directory;
    for (auto const& [name, content] : files) {
        boost::crc_32_type sum;
        sum.process_bytes(content.data(), content.size());
        std::string entry; // of the file and of the directory alike
        put(entry, 2, 20); // version
        put(entry, 8, 0); // flags, method and time
        put(entry, 4, sum.checksum());
        put(entry, 4, content.size());
        put(entry, 4, content.size());
        put(entry, 2, name.size());
        put(entry, 2, 0);
        directory += "PK\1\2";
        put(directory, 2, 20);
        directory += entry;
        put(directory, 10, 0); // remark, disk and attributes
        put(directory, 4, out.size());
        directory += name;
        out += "PK\3\4" + entry + name + content;
    }
    std::size_t const at = out.size();
    out += directory + "PK\5\6";
    put(out, 4, 0);
    put(out, 2, files.size());
    put(out, 2, files.size());
    put(out, 4, directory.size());
    put(out, 4, at);
    put(out, 2, 0);
    return out;
}

/// An object that is made of itself.
std::string three_mf() {
    std::string const head = "<?xml version=\"1.0\"?>";
    std::string const schemas = "http://schemas.microsoft.com/3dmanufacturing/";
    std::string const package = "http://schemas.openxmlformats.org/package/2006/";
    return zip(
        {{"[Content_Types].xml",
          head + "<Types xmlns=\"" + package +
              "content-types\"><Default Extension=\"model\" "
              "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
         {"_rels/.rels", head + "<Relationships xmlns=\"" + package + "relationships\"><Relationship Id=\"r\" Type=\"" +
                             schemas + "2013/01/3dmodel\" Target=\"/3D/3dmodel.model\"/></Relationships>"},
         {"3D/3dmodel.model",
          head + "<model unit=\"millimeter\" xmlns=\"" + schemas +
              "core/2015/02\"><resources><object id=\"1\" type=\"model\"><components><component "
              "objectid=\"1\"/></components></object></resources><build><item objectid=\"1\"/></build></model>"}});
}

TEST(TreeScene, OneThatEndsItsReaderIsALine) {
    TemporaryFolder const folder;
    for (auto const& [name, text] :
         {std::pair("a.dae", dae()), {"a.x3d", x3d()}, {"a.bvh", bvh()}, {"a.fbx", fbx()}, {"a.3mf", three_mf()}}) {
        std::string const scene = folder.write(name, text);
        for (std::vector<std::string> const& words : {std::vector<std::string>{scene}, {"--info", scene}}) {
            Process server(FRAMELET_SERVER, words);
            EXPECT_EQ(server.wait(patience), 1) << name;
            std::string const told = server.errors();
            EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
            EXPECT_NE(told.find(std::string(name) + "': "), std::string::npos) << told;
#ifndef FRAMELET_SANITIZE // a sanitizer has last words of its own
            EXPECT_NE(told.find("it ends the process that reads it"), std::string::npos) << told;
#endif
        }
    }
}

} // namespace
} // namespace framelet::test
