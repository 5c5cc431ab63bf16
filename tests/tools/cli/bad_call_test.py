# SPDX-License-Identifier: GPL-3.0-or-later
"""A call that asks for what cannot be is refused with one line, and no file is made or changed."""
import phonomime_cli as cli
import tiny_corpus

SPOKEN = "b aa m eh p iy s ow l f".split()


class BadCallTest(cli.DatabaseTest):
    """A database of two emotions, a transcript, a face, and an output of an earlier call."""

    CORPUS = {"emotions": ("neutral", "happiness")}

    def setUp(self):
        super().setUp()
        self.transcript = cli.write_transcript(self.folder / "hello.lab", SPOKEN)
        self.face = tiny_corpus.write_face(self.folder / "face")
        self.outputs = [self.folder / f"out.{kind}" for kind in cli.KINDS]
        for path in self.outputs:
            path.write_text("of an earlier call")

    def file(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def synth(self, *arguments):
        outputs = [word for path in self.outputs for word in ("-o", path)]
        face = [] if "--face" in arguments else ["--face", self.face]
        return ["synth", "--db", self.database, self.transcript, *face, *outputs, *arguments]

    def assertSynthRefused(self, *words, arguments=(), status=cli.BAD_INPUT, **options):
        return self.assertRefused(status, words, *self.synth(*arguments), **options)

    def assertOptionRefused(self, option, text, *words):
        """Of a file that an option names; words of the form ":2" are lines of it."""
        path = self.file("option.txt", text)
        self.assertSynthRefused(*(f"{path}{word}" if word.startswith(":") else word for word in words),
                                arguments=(option, path))

    def test_the_call_is_good_before_it_is_spoilt(self):
        constraints = self.file("good", "3 use ann/neutral/u004#6 neutral/u000#3\n5 avoid ann/happiness/u001#2\n")
        emotions = self.file("track", "0 0.8 neutral\n0.8 1.6 happiness 1\n")
        weights = self.file("weights.json", '{"alpha4": 0.5}')
        cli.run_well(*self.synth("--constraints", constraints, "--emotions", emotions, "--weights", weights))
        for path in self.outputs:
            self.assertGreater(path.stat().st_size, 100)

    # Transcript

    def test_transcripts(self):
        cases = {
            "#\n0.3 100 pau\n0.5 100 b\n0.7 100 axx\n": (":4", '"axx"', '"ax"'),
            "#\n0.3 100 pau\n0.9 100 b\n0.5 100 aa\n": (":4", "0.5"),
            "#\n0.3 100 pau\nnan 100 b\n": (":3",),
            "#\n0.3 100 pau\n0.3 100 b\n0.5 100 pau\n": (":3",),
            "#\n": ("no rows",),
            "": (),
        }
        for text, words in cases.items():
            with self.subTest(text):
                self.transcript.write_text(text)
                self.assertSynthRefused(self.transcript.name, *words)

    def test_a_transcript_of_a_thousand_years(self):
        for end_s in ("7201", "3e10", "1e300"):
            with self.subTest(end_s):
                self.transcript.write_text(f"#\n0.3 100 pau\n{end_s} 100 b\n")
                line = self.assertSynthRefused(f"{self.transcript}:3: the transcript is too long", "7200 s")
                self.assertLess(len(line), 400)

    def test_a_transcript_that_is_not_there(self):
        self.transcript.unlink()
        self.assertSynthRefused("hello.lab", "No such file", status=cli.IO)

    # Constraints, emotions, weights

    def test_constraints_that_cannot_be_met(self):
        cases = {
            "3 use ann/neutral/u099#1\n": (":1", '"ann/neutral/u099#1"'),
            "# nodes\n\n3 use ann/neutral/u004#0\n": (":3", '"ann/neutral/u004#0"', "ann/neutral/u004#1"),
            "3 use u004#6\n": (":1", "ambiguous", "ann/happiness/u004#6", "ann/neutral/u004#6"),
            "3 use ann/neutral/u004#6\n3 use ann/neutral/u004#7\n": (":2", "row 3"),
            "3 use ann/neutral/u004#6\n3 avoid ann/neutral/u004#6\n": (":2", "row 3"),
            "at 0.55 use ann/neutral/u004#6\n3 use ann/neutral/u004#7\n": (":2", "row 3"),
            "12 use ann/neutral/u004#6\n": (":1", "0 to 11", "12"),
            "-1 use ann/neutral/u004#6\n": (":1", "-1"),
            "at 99 use ann/neutral/u004#6\n": (":1", "99"),
            "3 take ann/neutral/u004#6\n": (":1", '"use" or "avoid"', '"take"'),
            "3 use\n": (":1",),
        }
        for text, words in cases.items():
            with self.subTest(text):
                self.assertOptionRefused("--constraints", text, *words)

    def test_avoiding_every_node_there_is(self):
        keys = [node["key"] for node in cli.run_json("nodes", self.database)]
        self.assertOptionRefused("--constraints", f"3 avoid {' '.join(keys)}\n", ":1", "row 3")

    def test_emotion_tracks(self):
        cases = {
            "0 1 neutral\n0.5 1.2 happiness\n": (":2", "overlaps line 1"),
            "0.5 1.2 happiness\n0 1 neutral\n": ("overlaps",),
            "0 1 neutral\n1 0.5 happiness\n": (":2", "0.5"),
            "0 1 neutral\n1 1.5 hapiness\n": (":2", '"hapiness"', '"happiness"'),
            "0 1 neutral\n1 1.5 happiness 0.5\n": (":2", "0.5", "style model"),
            "0 1 happiness:1.2\n": (":1", "1.2", "style model"),
            "0 1 happiness 1.6\n": (":1", "0 to 1.5", "1.6"),
            "0 1 happiness:0.6+neutral:0.4\n": (":1", "style model"),
            "0 1\n": (":1",),
            "0 one happiness\n": (":1", "one"),
        }
        for text, words in cases.items():
            with self.subTest(text):
                self.assertOptionRefused("--emotions", text, *words)

    def test_one_emotion_throughout(self):
        cases = {
            "hapiness": ('"hapiness"', '"happiness"', "neutral"),
            "happiness:0.5": ("0.5", "style model"),
            "happiness:2": ("0 to 1.5", "2"),
            "happiness:": ("--emotion",),
        }
        for name, words in cases.items():
            with self.subTest(name):
                self.assertSynthRefused(*words, arguments=("--emotion", name))

    def test_weights(self):
        cases = {
            '{"alpha4": 1}': ("alpha4",),
            '{"alpha4": 0}': ("alpha4",),
            '{"alpha1": -1}': ("alpha1", "-1"),
            '{"pnt": "much"}': ("pnt",),
            '{"pnt": 1e999}': ("",),
            '{"alpha7": 1}': ('"alpha7"', "alpha"),
            '{"alpha1": 1, "alpha1": 2}': ("alpha1",),
            "[1]": ("",),
            "{": ("JSON",),
        }
        for text, words in cases.items():
            with self.subTest(text):
                self.assertOptionRefused("--weights", text, "option.txt", *words)

    # Faces and sound

    def test_faces(self):
        table = (self.face / "markers.tsv").read_text()
        mesh = (self.face / "mask.obj").read_text()
        glb = b"glTF" + (2).to_bytes(4, "little") + (2**32 - 1).to_bytes(4, "little") + b"\xff\xff\xff\xffJSON{}"
        cases = {
            "a vertex that is not there": ("markers.tsv", table.replace("chin\t", "chin\t99")),
            "a marker twice": ("markers.tsv", table + "chin\t7\n"),
            "a table without numbers": ("markers.tsv", "marker\tvertex\nchin\tthere\n"),
            "an empty table": ("markers.tsv", ""),
            "a face of vertices that are not there": ("mask.obj", mesh + "f 1 2 99999999\n"),
            "a face of negative vertices": ("mask.obj", mesh + "f -1 -2 -99999999\n"),
            "coordinates that are not numbers": ("mask.obj", "v nan 0 0\n" + mesh),
            "no faces": ("mask.obj", "v 0 0 0\n"),
            "an empty mesh": ("mask.obj", ""),
            "a hostile GLB": ("mask.obj", glb),
        }
        for name, (file, text) in cases.items():
            with self.subTest(name):
                tiny_corpus.write_face(self.face)
                self.file(f"face/{file}", text)
                self.assertSynthRefused("/face/")
        with self.subTest("a hostile GLB by its name"):
            self.assertSynthRefused("head.glb", arguments=("--face", self.file("head.glb", glb)))

    def test_a_face_that_is_not_there(self):
        self.face = self.folder / "nowhere"
        self.assertSynthRefused("nowhere", "No such file", status=cli.IO)

    def test_files_that_options_name_and_that_are_not_there(self):
        nowhere = self.folder / "nowhere.json"
        for option in ("--emotions", "--constraints", "--weights", "--phoneme-set", "--audio", "--face"):
            with self.subTest(option):
                self.assertSynthRefused(nowhere, "No such file", arguments=(option, nowhere), status=cli.IO)

    def test_sound_that_is_none(self):
        self.assertSynthRefused("noise.wav", "WAV", arguments=("--audio", self.file("noise.wav", "no sound")))
        self.assertSynthRefused("cut.wav", arguments=("--audio", self.file("cut.wav", b"RIFF\xff\xff\xff\xffWAVEfmt ")))

    # Words of the call

    def test_usage(self):
        synth = ["synth", "--db", self.database, self.transcript]
        cases = [
            ([*synth, "-o", self.folder / "new.xyz"], ("new.xyz", '".xyz"', ".html")),
            ([*synth, "-o", self.folder / "new"], ("new", ".html")),
            ([*synth, "-o", self.folder / "new.html"], ("--face",)),
            ([*synth, "-o", self.folder / "new.glb"], ("--face",)),
            ([*synth, "--fps", "0"], ("--fps", "1 to 1000")),
            ([*synth, "--fps", "nan"], ("--fps",)),
            ([*synth, "--fps", "many"], ("--fps", "many")),
            ([*synth, "--head", "1,2"], ("--head", "YAW,PITCH,ROLL", "1,2")),
            ([*synth, "--threads", "-1"], ("--threads",)),
            ([*synth, "--silence", "square"], ("--silence", "square")),
            ([*synth, "--shout"], ("--shout", "phonomime synth --help")),
            (["synth", self.transcript], ("--db",)),
            (["synth", "--db", self.database], ("transcript",)),
            (["import", self.folder, "--db", self.folder / "new.db", "--rate", "5"], ("rate", "10 to 1000")),
            (["import", self.folder, "--db", self.folder / "new.db", "--dimensions", "0"], ("dimensions", "at least 1")),
            (["import", self.folder, "--db", self.folder / "new.db", "--share", "2"], ("--share",)),
            (["import", self.folder, "--db", self.folder / "new.db", "--share", "0"], ("--share", "above 0 and up to 1", "got 0")),
            (["import", self.folder, "--db", self.folder / "new.db", "--share", "nan"], ("--share", "above 0 and up to 1")),
            (["nodes", self.database, "--limit", "-1"], ("--limit", "0 (all) or more", "got -1")),
            (["frobnicate", self.database], ('"frobnicate"', "one of import, info, nodes, suspects", "--help")),
            (["sinth", self.database], ('"sinth"', 'Did you mean "synth"?')),
            (["nods", self.database], ('"nods"', 'Did you mean "nodes"')),
            ([], ("verb", "one of import, info", "--help")),
        ]
        for arguments, words in cases:
            with self.subTest(" ".join(map(str, arguments))):
                self.assertRefused(cli.USAGE, words, *arguments)

    def test_an_output_that_is_named_twice(self):
        (self.folder / "sub").mkdir()
        (self.folder / "link").symlink_to(self.folder / "sub")
        new = self.folder / "sub/new.csv"
        for other in (new, f"{self.folder}/sub/./new.csv", f"{self.folder}/sub/../sub//new.csv", self.folder / "link/new.csv"):
            with self.subTest(other):
                self.assertRefused(cli.USAGE, [new, "twice"], "synth", "--db", self.database, self.transcript, "-o", other, new)
        cli.run_well("synth", "--db", self.database, self.transcript, "-o", new, self.folder / "new.csv")

    def test_nodes_of_names_that_are_not_there(self):
        cases = {
            ("--phoneme", "ahh"): ("phoneme", '"ahh"', '"ah"'),
            ("--phoneme", "zzz"): ("phoneme", '"zzz"', "one of aa"),
            ("--previous", "pou"): ("phoneme", '"pou"', '"pau"'),
            ("--next", "ahh"): ("phoneme", '"ahh"', '"ah"'),
            ("--emotion", "hapiness"): ("emotion", '"hapiness"', '"happiness"', "one of happiness, neutral"),
            ("--speaker", "anne"): ("speaker", '"anne"', 'Did you mean "ann"?'),
            ("--sentence", "u00"): ("sentence", '"u00"', '"u000"'),
        }
        for (option, name), words in cases.items():
            with self.subTest(option, name=name):
                self.assertRefused(cli.BAD_INPUT, [self.database, *words], "nodes", self.database, option, name)

    def test_a_speaker_that_is_not_there(self):
        self.assertSynthRefused('"bob"', "ann", arguments=("--speaker", "bob"))

    def test_explaining_what_is_no_result(self):
        self.assertRefused(cli.BAD_INPUT, ["hello.lab", "JSON"], "explain", self.transcript)
        self.assertRefused(cli.BAD_INPUT, ["other.json"], "explain", self.file("other.json", '{"format": "phonomime-result"}'))
        self.assertRefused(cli.IO, ["none.json"], "explain", self.folder / "none.json")

    # Disks

    def test_places_that_cannot_be_written(self):
        (self.folder / "folder.csv").mkdir()
        for place in ("made.db/new.csv", "nowhere/new.csv", "/proc/new.csv", "folder.csv"):
            with self.subTest(place):
                self.outputs[2] = self.folder / place
                self.assertSynthRefused(self.outputs[2], status=cli.IO)

    def test_a_read_only_folder(self):
        sealed = self.folder / "sealed"
        sealed.mkdir()
        cli.seal(self, sealed)
        self.outputs[1] = sealed / "new.glb"
        self.assertSynthRefused("sealed/new.glb", status=cli.IO, as_user=True)


if __name__ == "__main__":
    cli.main()
