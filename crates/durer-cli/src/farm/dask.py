@still """@NAME@: renders in @SHARDS@ shards on a Dask cluster. Pass the scheduler's address, or nothing to start one on this machine."""
@frames """@NAME@: renders frames @FIRST@-@LAST@:@STEP@ on a Dask cluster. Pass the scheduler's address, or nothing to start one on this machine."""

@frames import re
import sys

import durer.farm
from distributed import Client

@frames FRAMES = range(@FIRST@, @LAST@ + 1, @STEP@)
@frames
@frames
@frames def numbered(word, frame):
@frames     return re.sub(r"%(0\d)?d", lambda place: place.group() % frame, word)
@frames
@frames
@frames def world(frame):
@frames     words = [*@WORDS_PYTHON@@MOVING_WORDS@]
@frames     return durer.load(numbered(@SCENE_PYTHON@, frame), words=[numbered(word, frame) for word in words])
@frames
@frames
if __name__ == "__main__":
    client = Client(sys.argv[1]) if len(sys.argv) > 1 else Client(threads_per_worker=1)
@still     pictures = durer.farm.render(@SCENE_PYTHON@, client=client, shards=@SHARDS@, words=@WORDS_PYTHON@)
@still     pictures.save(@OUTPUT_PYTHON@)
@still     print(pictures.hash)
@frames     for frame, pictures in zip(FRAMES, durer.farm.frames(map(world, FRAMES), client=client, shards=@SHARDS@)):
@frames         pictures.save(numbered(@OUTPUT_PYTHON@, frame))
@frames         print(frame, pictures.hash)
    client.close()
