# SPDX-License-Identifier: GPL-3.0-or-later
"""phonomime map: what is stored, when it is stale, what is picked, what pictures show."""
import random
import shutil
import struct
import subprocess
import xml.etree.ElementTree

import map_database
import phonomime_cli as cli
import tiny_corpus

SVG = "{http://www.w3.org/2000/svg}"


class MapTest(cli.DatabaseTest):
    CORPUS = {"emotions": ("neutral", "happiness"), "sentences": 8}

    def build(self, *arguments):
        return cli.run_json("map", "build", self.database, *arguments)

    def states(self):
        return {shown["phoneme"]: shown["state"] for shown in cli.run_json("map", "show", self.database)}

    def keys(self, *filters):
        return [node["key"] for node in cli.run_json("nodes", self.database, *filters)]

    def phonemes(self):
        return sorted({node["phoneme"] for node in cli.run_json("nodes", self.database)})

    # What is stored

    def test_every_phoneme_gets_its_map_once(self):
        built = self.build()
        self.assertEqual([entry["phoneme"] for entry in built], self.phonemes())
        self.assertTrue(all(entry["built"] for entry in built))
        self.assertEqual(set(self.states().values()), {"fresh"})
        for entry in built:
            frames = map_database.frames(self.database, entry["phoneme"])
            self.assertEqual((entry["frames"], entry["placed"]), (len(frames), len(frames)))
            self.assertEqual(entry["nodes"], len({key for key, _, _ in frames}))
            for variance in entry["residual_variance"].values():
                self.assertTrue(0 <= variance <= 1, entry)
        before = cli.contents(self.folder)
        again = self.build()
        self.assertFalse(any(entry["built"] for entry in again))
        self.assertEqual(cli.contents(self.folder), before)

    def test_threads_change_no_byte(self):
        self.build("--threads", 1)
        one = map_database.maps(self.database)
        self.database.write_bytes(self.made)
        self.build("--threads", 4)
        self.assertEqual(map_database.maps(self.database), one)

    def test_only_some_phonemes(self):
        self.assertEqual([entry["phoneme"] for entry in self.build("--phoneme", "b", "aa")], ["aa", "b"])
        states = self.states()
        self.assertEqual({name for name, state in states.items() if state == "fresh"}, {"aa", "b"})
        self.assertEqual(set(states.values()), {"fresh", "missing"})

    def test_other_options_make_other_maps(self):
        self.build()
        usual = map_database.maps(self.database)
        for options in (["--components", "largest"], ["--largest-exact", 4000], ["--landmarks", 400], ["--seed", 2],
                        ["--neighbours", 5]):
            self.assertTrue(all(entry["built"] for entry in self.build(*options)), options)
        other = map_database.maps(self.database)
        self.assertEqual({entry["neighbours"] for entry in other.values()}, {5})
        self.assertNotEqual({name: entry["isomap"] for name, entry in other.items()},
                            {name: entry["isomap"] for name, entry in usual.items()})
        self.assertEqual(set(self.states().values()), {"fresh"})  # by their own options
        self.build()
        self.assertEqual(map_database.maps(self.database), usual)

    def test_parts_that_nothing_joins(self):
        """k = 1 leaves many parts: all frames are on the map, or the largest part alone."""
        joined = {entry["phoneme"]: entry for entry in self.build("-k", 1)}
        largest = {entry["phoneme"]: entry for entry in self.build("-k", 1, "--components", "largest")}
        self.assertTrue(any(entry["components"] > 1 for entry in joined.values()))
        for phoneme, entry in largest.items():
            self.assertEqual(entry["components"], joined[phoneme]["components"])
            self.assertEqual(joined[phoneme]["placed"], joined[phoneme]["frames"])
            self.assertEqual(entry["placed"] < entry["frames"], entry["components"] > 1)
            picture = self.folder / "part.svg"
            cli.run_well("map", "image", self.database, phoneme, "-o", picture, "--time-correct", 0.5)
            cli.run_well("map", "quality", self.database, "--phoneme", phoneme)
            cli.run_well("map", "pick", self.database, phoneme, 0, 0)

    def test_landmarks(self):
        built = self.build("--largest-exact", 30, "--landmarks", 20, "--seed", 5)
        for entry in built:
            self.assertEqual(entry["landmarks"], 20 if entry["frames"] > 30 else 0)
        other = {name: entry["isomap"] for name, entry in map_database.maps(self.database).items()}
        self.build("--largest-exact", 30, "--landmarks", 20, "--seed", 6)
        self.assertNotEqual({name: entry["isomap"] for name, entry in map_database.maps(self.database).items()}, other)

    def test_a_phoneme_of_one_frame(self):
        folder = self.folder / "short"
        rows = [(0.3, "pau"), (0.301, "b"), (0.6, "aa"), (0.9, "pau")]
        corpus = tiny_corpus.Corpus(folder, sentences=0)
        corpus.sentences = [tiny_corpus.Sentence("u0", rows)]
        database = self.folder / "short.db"
        cli.run_well("import", corpus.write(), "--db", database)
        built = {entry["phoneme"]: entry for entry in cli.run_json("map", "build", database)}
        self.assertEqual((built["b"]["nodes"], built["b"]["frames"]), (1, 1))
        picked = cli.run_json("map", "pick", database, "b", 1, 1)
        self.assertFalse(picked["inside"])
        self.assertEqual((picked["nearest"]["x"], picked["nearest"]["y"]), (0, 0))
        for kind in ("png", "svg"):
            cli.run_well("map", "image", database, "b", "-o", self.folder / f"b.{kind}", "--time-correct", 1)
        cli.run_well("map", "quality", database)

    def test_an_old_database(self):
        shutil.copyfile(cli.SOURCE_DIR / "tests/data/motion_database_v1.db", self.database)
        built = self.build()
        self.assertEqual([entry["phoneme"] for entry in built], ["aa", "k", "l", "m", "n", "s"])
        self.assertEqual([entry["nodes"] for entry in built], [2, 1, 2, 2, 2, 2])  # one /k/ is pruned
        self.assertEqual(set(self.states().values()), {"fresh"})

    def test_a_database_that_may_not_be_written(self):
        self.build("--phoneme", "aa")
        cli.seal(self, self.folder)
        self.database.chmod(0o400)
        shown = cli.run("map", "show", self.database, as_user=True)
        self.assertEqual(shown.returncode, cli.DONE, shown.stderr)
        cli.run_well("map", "pick", self.database, "aa", 0, 0, as_user=True)
        self.assertRefused(cli.IO, [self.database], "map", "build", self.database, as_user=True)

    def test_a_disk_without_room(self):
        room = self.database.stat().st_size
        stopped = cli.run("map", "build", self.database, "--threads", 1, preexec_fn=cli.limit_file_size(room))
        self.assertEqual(stopped.returncode, cli.IO, stopped.stderr)
        self.assertEqual(stopped.stderr.count("\n"), 1, stopped.stderr)
        self.assertIn(str(self.database), stopped.stderr)
        kept = set(map_database.maps(self.database))
        self.assertEqual({name for name, state in self.states().items() if state == "fresh"}, kept)
        self.assertEqual({entry["phoneme"] for entry in self.build() if not entry["built"]}, kept)

    def test_two_builds_at_once(self):
        self.build()
        alone = map_database.maps(self.database)
        self.database.write_bytes(self.made)
        command = [cli.PROGRAM, "map", "build", self.database, "--quiet"]
        both = [subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for _ in range(2)]
        for process in both:
            _, said = process.communicate(timeout=cli.TIME_LIMIT_S)
            self.assertEqual(process.returncode, cli.DONE, said)
        self.assertEqual(map_database.maps(self.database), alone)

    # Fresh and stale

    def image(self, name, phoneme="aa", *arguments):
        picture = self.folder / f"{name}.svg"
        result = cli.run("map", "image", self.database, phoneme, "-o", picture, *arguments)
        self.assertEqual(result.returncode, cli.DONE, result.stderr)
        return picture.read_bytes(), result.stderr

    def test_a_pruned_node_makes_its_phoneme_stale(self):
        self.build()
        before, said = self.image("before")
        self.assertEqual(said, "")
        stored = map_database.maps(self.database)
        cli.prune(self.database, self.keys("--phoneme", "aa")[1])
        states = self.states()
        self.assertEqual([name for name, state in states.items() if state != "fresh"], ["aa"])
        self.assertEqual(states["aa"], "stale")

        made_anew, said = self.image("anew")  # not the stale one, and it is not stored
        self.assertIn("stale", said)
        self.assertNotEqual(made_anew, before)
        self.assertEqual(map_database.maps(self.database), stored)
        self.assertEqual(cli.run_json("map", "pick", self.database, "aa", 0, 0)["state"], "stale")
        self.assertEqual([entry["phoneme"] for entry in self.build() if entry["built"]], ["aa"])
        self.assertEqual(self.image("after"), (made_anew, ""))

        cli.run_well("restore", self.database, "--phoneme", "aa", "--reason", "fine")
        self.assertEqual(self.states()["aa"], "stale")
        self.build()
        self.assertEqual(map_database.maps(self.database), stored)
        self.assertEqual(self.image("again"), (before, ""))

    def test_a_restored_node_makes_the_map_fresh_again(self):
        self.build()
        cli.prune(self.database, self.keys("--phoneme", "aa")[0])
        self.assertEqual(self.states()["aa"], "stale")
        cli.run_well("restore", self.database, "--phoneme", "aa", "--reason", "fine")
        self.assertEqual(self.states()["aa"], "fresh")

    def test_a_phoneme_that_is_pruned_altogether(self):
        self.build()
        for key in self.keys("--phoneme", "aa"):
            cli.prune(self.database, key)
        shown = {entry["phoneme"]: entry for entry in cli.run_json("map", "show", self.database)}
        self.assertEqual((shown["aa"]["state"], shown["aa"]["nodes"]), ("stale", 0))
        self.assertRefused(cli.BAD_INPUT, ['"aa"'], "map", "pick", self.database, "aa", 0, 0)
        self.assertNotIn("aa", [entry["phoneme"] for entry in self.build()])

    def test_an_import_makes_all_stale(self):
        self.build()
        more = tiny_corpus.Corpus(self.folder / "more", name="more", sentences=1, phonemes=3, first=700)
        for sentence in more.sentences:
            sentence.speaker = "ann"
        cli.run_well("import", more.write(), "--db", self.database)
        self.assertEqual(set(self.states().values()), {"stale"})

    def test_a_changed_frame_makes_its_phonemes_stale(self):
        """What an import of the same names with another PCA would leave."""
        self.build()
        key, frame, _ = map_database.frames(self.database, "aa")[0]
        with map_database.opened(self.database) as connection:
            sentence, first = connection.execute(
                "SELECT n.sentence_id, n.first_frame FROM nodes n JOIN sentences s ON s.id = n.sentence_id "
                "JOIN emotions e ON e.id = s.emotion_id WHERE e.name || '/' || s.name || '#' || n.row = ?",
                (key.split("/", 1)[1],)).fetchone()
            blob = bytearray(connection.execute("SELECT frames FROM coefficients WHERE sentence_id = ?",
                                                (sentence,)).fetchone()[0])
            at = 4 * connection.execute("SELECT dimensions FROM pca").fetchone()[0] * (first + frame)
            struct.pack_into("<f", blob, at, struct.unpack_from("<f", blob, at)[0] + 0.001)
            connection.execute("UPDATE coefficients SET frames = ? WHERE sentence_id = ?", (bytes(blob), sentence))
        self.assertEqual([name for name, state in self.states().items() if state == "stale"], ["aa"])

    # Picking

    def test_picks_against_brute_force(self):
        self.build()
        for phoneme, kind in (("aa", "isomap"), ("b", "pca")):
            frames = map_database.frames(self.database, phoneme)
            places = map_database.places(map_database.maps(self.database)[phoneme], kind)
            self.assertEqual(len(places), len(frames))
            self.assertGreater(len(places), 20)
            of_frame = {(key, frame): i for i, (key, frame, _) in enumerate(frames)}
            pick = random.Random(3)
            inside = 0
            for _ in range(25):  # on the line through two frames, between them or beyond
                (ax, ay), (bx, by), share = *pick.sample(places, 2), pick.uniform(-0.7, 1.7)
                x, y = ax + share * (bx - ax), ay + share * (by - ay)
                picked = cli.run_json("map", "pick", self.database, phoneme, x, y, "--map", kind)
                with self.subTest(phoneme, x=x, y=y):
                    inside += picked["inside"]
                    self.check_pick(picked, x, y, places, frames, of_frame)
            self.assertTrue(5 < inside < 25, inside)

    def check_pick(self, picked, x, y, places, frames, of_frame):
        distances = [(px - x) ** 2 + (py - y) ** 2 for px, py in places]
        nearest = of_frame[picked["nearest"]["node"], picked["nearest"]["frame"]]
        self.assertAlmostEqual(distances[nearest], min(distances))
        self.assertAlmostEqual(picked["nearest"]["distance"] ** 2, min(distances))
        corners = [of_frame[corner["node"], corner["frame"]] for corner in picked["corners"]]
        weights = [corner["weight"] for corner in picked["corners"]]
        for corner, index in zip(picked["corners"], corners):
            self.assertEqual((corner["x"], corner["y"]), places[index])
        self.assertAlmostEqual(sum(weights), 1)
        if picked["inside"]:
            self.assertTrue(all(0 <= weight <= 1 for weight in weights))
            for axis, value in ((0, x), (1, y)):
                self.assertAlmostEqual(sum(w * places[i][axis] for w, i in zip(weights, corners)), value, places=6)
            self.assertEmptyCircle([places[i] for i in corners], places)
        else:
            self.assertEqual((corners, weights), ([nearest], [1]))
            self.assertOutside(x, y, places)
        mean = [sum(w * frames[i][2][d] for w, i in zip(weights, corners)) for d in range(len(frames[0][2]))]
        for a, b in zip(picked["channels"].values(), map_database.reconstruct(self.database, mean)):
            self.assertAlmostEqual(a, b, places=5)

    def assertEmptyCircle(self, triangle, places):
        """Delaunay: no place lies within the circle through the corners."""
        (ax, ay), (bx, by), (cx, cy) = triangle
        d = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
        ux = ((ax * ax + ay * ay) * (by - cy) + (bx * bx + by * by) * (cy - ay) + (cx * cx + cy * cy) * (ay - by)) / d
        uy = ((ax * ax + ay * ay) * (cx - bx) + (bx * bx + by * by) * (ax - cx) + (cx * cx + cy * cy) * (bx - ax)) / d
        radius_sq = (ax - ux) ** 2 + (ay - uy) ** 2
        for px, py in places:
            self.assertGreaterEqual((px - ux) ** 2 + (py - uy) ** 2, radius_sq * (1 - 1e-6))

    def assertOutside(self, x, y, places):
        """Some line through two places has all places on one side and this one on the other."""
        def side(a, b, c):
            return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        self.assertTrue(any(side(a, b, (x, y)) < 0 and all(side(a, b, c) >= -1e-9 for c in places)
                            for a in places for b in places if a != b))

    def test_a_picked_frame_as_a_face(self):
        self.build()
        face = tiny_corpus.write_face(self.folder / "face")
        outputs = [self.folder / "aa.glb", self.folder / "aa.csv"]
        picked = cli.run_json("map", "pick", self.database, "aa", 0.5, 0, "--face", face, "-o", *outputs)
        self.assertEqual(outputs[0].read_bytes()[:4], b"glTF")
        names, values, *rest = (line.split(",") for line in outputs[1].read_text().splitlines())
        self.assertEqual((names[0], rest), ("time", []))
        self.assertEqual(names[1:], list(picked["channels"]))
        for written, value in zip(values[1:], picked["channels"].values()):
            self.assertAlmostEqual(float(written), value, places=3)

    # Pictures

    def layers(self, picture):
        """{name: shapes} of an SVG picture."""
        root = xml.etree.ElementTree.fromstring(picture)
        return {group.get("id"): list(group) for group in root.findall(f"{SVG}g")}

    def lines(self, shapes):
        """Trajectories, without their halos."""
        return [shape for shape in shapes if shape.get("fill") == "none" and shape.get("stroke") != "#ffffff"]

    def test_roles_in_a_picture(self):
        nodes = cli.run_json("nodes", self.database, "--phoneme", "aa")
        triphone = (nodes[0]["previous"], nodes[0]["next"])
        in_context = self.keys("--phoneme", "aa", "--previous", triphone[0], "--next", triphone[1])
        others = [node["key"] for node in nodes if node["key"] not in in_context]
        chosen, suspect, pruned = others[:2], others[2], others[3]
        cli.prune(self.database, pruned)
        with map_database.opened(self.database) as connection:
            connection.execute("DELETE FROM suspects")
            connection.execute("INSERT INTO suspects SELECT n.sentence_id, n.row, 'jump', 'channels', 1, 0, 1, '[]', 'test' FROM nodes n "
                               "JOIN sentences s ON s.id = n.sentence_id JOIN emotions e ON e.id = s.emotion_id "
                               "WHERE e.name || '/' || s.name || '#' || n.row = ?", (suspect.split("/", 1)[1],))
        self.build()
        asked = ["--time-correct", 0.25, "--context", *triphone, "--nodes", *chosen, "--suspects", "--pruned"]
        report = cli.run_json("map", "image", self.database, "aa", "-o", self.folder / "aa.svg", self.folder / "aa.png", *asked)
        self.assertEqual(report["highlighted"], {"context_correct": len(in_context), "chosen": 2, "suspect": 1, "pruned": 1})
        layers = self.layers((self.folder / "aa.svg").read_bytes())
        plain = len(nodes) - len(in_context) - 2 - 1 - 1
        for name, count in (("motion node", plain), ("same triphone", len(in_context)), ("chosen", 2),
                            ("suspect", 1), ("pruned", 1)):
            self.assertEqual(len(self.lines(layers[name])), count, name)
        self.assertEqual(len(layers["at this time"]), plain + 1)  # the suspect, too
        self.assertEqual(len(layers["same triphone, at this time"]), len(in_context))
        self.assertEqual(len(layers["chosen, at this time"]), 2 * 2)
        self.assertEqual((self.folder / "aa.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        legend = [shape.text for shape in layers["legend"] if shape.tag == f"{SVG}text"]
        self.assertEqual(legend[1:3], ["happiness", "neutral"])

        bare, _ = self.image("bare", "aa", "--only-highlights", "--no-legend")
        self.assertEqual(self.layers(bare), {})

    def test_the_nodes_of_a_path(self):
        transcript = cli.write_transcript(self.folder / "hello.lab", "b aa m eh aa iy".split())
        result = self.folder / "hello.json"
        cli.run_well("synth", "--db", self.database, transcript, "-o", result)
        nodes = {row["node"] for row in cli.json.loads(result.read_text())["path"] if row["phoneme"] == "aa"}
        report = cli.run_json("map", "image", self.database, "aa", "-o", self.folder / "aa.svg", "--path", result)
        self.assertEqual(report["highlighted"]["chosen"], len(nodes))

    def test_a_palette(self):
        picture, _ = self.image("own", "aa", "--palette", "happiness=#123456", "--size", "300x200")
        fills = {shape.get("fill") for shape in self.layers(picture)["legend"]}
        self.assertIn("#123456", fills)
        self.assertIn("#000000", fills)  # neutral's, E Fig. 5
        self.assertRegex(picture.decode(), r'<image y="\d+" width="300" height="200"')

    # Measures

    def test_quality(self):
        self.build()
        report = cli.run_json("map", "quality", self.database)
        self.assertEqual([entry["phoneme"] for entry in report["phonemes"]], self.phonemes())
        header, *lines = cli.run_well("map", "quality", self.database, "--csv").splitlines()
        self.assertEqual(len(lines), 2 * len(report["phonemes"]))
        rows = [dict(zip(header.split(","), line.split(","))) for line in lines]
        for measure, contest in report["compared"].items():
            pairs = [(float(a[measure]), float(b[measure]), int(a["frames"]))
                     for a, b in zip(rows[::2], rows[1::2]) if a[measure] and b[measure]]
            sign = -1 if measure == "residual_variance" else 1
            self.assertEqual(contest["phonemes"], len(pairs))
            self.assertEqual(contest["isomap_better"], sum(sign * (a - b) > 0 for a, b, _ in pairs), measure)
            self.assertEqual(contest["pca_better"], sum(sign * (a - b) < 0 for a, b, _ in pairs), measure)
            self.assertAlmostEqual(contest["isomap_mean"], sum(a * n for a, _, n in pairs) / sum(n for _, _, n in pairs))
        stored = map_database.maps(self.database)
        for entry in report["phonemes"]:
            for kind in ("isomap", "pca"):
                self.assertEqual(entry[kind]["residual_variance"], stored[entry["phoneme"]][f"{kind}_residual_variance"])
                purity = self.purity(map_database.frames(self.database, entry["phoneme"]),
                                     map_database.places(stored[entry["phoneme"]], kind))
                self.assertAlmostEqual(entry[kind]["purity"], purity)

    def purity(self, frames, places):
        """Mean share of a frame's 12 nearest on the map, its own node's left out, with its emotion."""
        shares = []
        for (key, _, _), (x, y) in zip(frames, places):
            others = sorted(((px - x) ** 2 + (py - y) ** 2, i) for i, (px, py) in enumerate(places) if frames[i][0] != key)
            nearest = [frames[i][0].split("/")[1] for _, i in others[:12]]
            shares.append(nearest.count(key.split("/")[1]) / len(nearest))
        return sum(shares) / len(shares)


class BadMapCallTest(cli.DatabaseTest):
    CORPUS = {"emotions": ("neutral", "happiness")}

    def test_words_of_the_call(self):
        db, new = self.database, self.folder / "new.png"
        image = ["map", "image", db, "aa", "-o", new]
        cases = [
            (["map"], ("verb", "build, show, image", "phonomime map --help")),
            (["map", "draw", db], ('"draw"', "build, show, image")),
            (["map", "imge", db], ('Did you mean "image"?',)),
            (["map", "build"], ("database", "phonomime map build --help")),
            (["map", "build", db, "--threads", "-1"], ("--threads", "0 to 256")),
            (["map", "build", db, "--components", "all"], ("--components", "join, largest", '"all"')),
            (["map", "build", db, "--neighbours", "many"], ("--neighbours",)),
            (["map", "build", db, "--neighbours", "0"], ("--neighbours", "1 to 1000")),
            (["map", "build", db, "--landmarks", "2"], ("--landmarks", "3 to 100000")),
            (["map", "build", db, "--largest-exact", "0"], ("--largest-exact", "1 to 100000")),
            (["map", "image", db, "aa"], ("--output",)),
            (["map", "image", db, "aa", "-o", self.folder / "new.gif"], ("new.gif", ".png or .svg")),
            ([*image, "-o", new, new], ("twice",)),
            ([*image, "--map", "tsne"], ("--map", "isomap, pca")),
            ([*image, "--size", "10x10"], ("--size", "64 to 8192", "10")),
            ([*image, "--size", "1000"], ("--size", "WIDTHxHEIGHT")),
            ([*image, "--size", "99999999999x100"], ("--size",)),
            ([*image, "--sigma", "0"], ("--sigma", "0.5 to 500")),
            ([*image, "--sigma", "nan"], ("--sigma",)),
            ([*image, "--time-correct", "1.5"], ("--time-correct", "0 to 1")),
            ([*image, "--context", "b"], ("--context",)),
            ([*image, "--palette", "happiness"], ("--palette", "EMOTION=#rrggbb")),
            ([*image, "--palette", "happiness=red"], ("--palette", "#rrggbb", '"red"')),
            (["map", "pick", db, "aa", "1"], ("y",)),
            (["map", "pick", db, "aa", "nan", "1"], ("X",)),
            (["map", "pick", db, "aa", "1e200", "1"], ("X",)),
            (["map", "pick", db, "aa", "1", "1", "-o", self.folder / "new.glb"], ("--face",)),
            (["map", "pick", db, "aa", "1", "1", "--face", self.folder], ("-o FILE.glb",)),
            (["map", "pick", db, "aa", "1", "1", "-o", new], (".glb or .csv",)),
        ]
        for arguments, words in cases:
            with self.subTest(" ".join(map(str, arguments))):
                self.assertRefused(cli.USAGE, words, *arguments)

    def test_what_is_not_there(self):
        db, new = self.database, self.folder / "new.png"
        image = ["map", "image", db, "aa", "-o", new]
        no_result = self.folder / "no.json"
        no_result.write_text("{}")
        other = next(node["key"] for node in cli.run_json("nodes", db, "--phoneme", "b"))
        cases = [
            (["map", "build", db, "--phoneme", "ahh"], ('"ahh"', "one of aa")),
            (["map", "build", db, "--speaker", "bob"], ('"bob"', "ann")),
            (["map", "show", db, "pau"], ('"pau"',)),
            (["map", "image", db, "zh", "-o", new], ('"zh"', "one of aa")),
            ([*image, "--palette", "hapiness=#ffffff"], ('"hapiness"', '"happiness"')),
            ([*image, "--context", "b", "ahh"], ("--context", '"ahh"')),
            ([*image, "--nodes", "nobody#1"], ("--nodes", '"nobody#1"')),
            ([*image, "--nodes", other], ("--nodes", other, "/aa/", "/b/")),
            ([*image, "--path", no_result], ("no.json",)),
            (["map", "pick", db, "pau", "0", "0"], ('"pau"',)),
            (["map", "quality", db, "--phoneme", "xx"], ('"xx"',)),
        ]
        for arguments, words in cases:
            with self.subTest(" ".join(map(str, arguments))):
                self.assertRefused(cli.BAD_INPUT, words, *arguments)

    def test_files_that_are_not_there(self):
        for arguments in (["build"], ["show"], ["image", "aa", "-o", self.folder / "new.png"], ["pick", "aa", 0, 0], ["quality"]):
            with self.subTest(arguments[0]):
                self.assertRefused(cli.IO, ["nowhere.db"], "map", arguments[0], self.folder / "nowhere.db", *arguments[1:])
        self.assertRefused(cli.IO, ["nowhere"], "map", "image", self.database, "aa", "-o", self.folder / "nowhere/new.png")

    def test_a_pruned_node_of_a_result(self):
        transcript = cli.write_transcript(self.folder / "hello.lab", ["b", "aa", "m"])
        result = self.folder / "hello.json"
        cli.run_well("synth", "--db", self.database, transcript, "-o", result)
        key = next(row["node"] for row in cli.json.loads(result.read_text())["path"] if row["phoneme"] == "aa")
        cli.prune(self.database, key)
        self.assertRefused(cli.BAD_INPUT, [result, key, "pruned"], "map", "image", self.database, "aa",
                           "-o", self.folder / "new.png", "--path", result)


if __name__ == "__main__":
    cli.main()
