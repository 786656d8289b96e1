"""@NAME@: renders in @SHARDS@ shards on a Dask cluster. Give the scheduler's address, or nothing for one on this machine."""

import sys

import durer.farm
from distributed import Client

if __name__ == "__main__":
    client = Client(sys.argv[1]) if len(sys.argv) > 1 else Client(threads_per_worker=1)
    pictures = durer.farm.render(@SCENE_JSON@, client=client, shards=@SHARDS@, words=@WORDS_JSON@)
    pictures.save(@OUTPUT_JSON@)
    print(pictures.hash)
    client.close()
