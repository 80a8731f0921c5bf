"""What differs from the accepted state: compared as data, said in words, shown in pictures.

Pictures are never compared. Tables are compared cell by cell, curves as curves, axes by what they say.
"""
